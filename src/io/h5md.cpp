// SPDX-License-Identifier: BSD-3-Clause
#include "io/h5md.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/checkpoint_fields.hpp"

namespace carrom::h5md {

namespace {

/// Writes /h5md: the author, the program, its version, and the units that the scene names.
void write_metadata(hid_t file, const RecordedSystem& system) {
    const std::string& program_version = system.program_version;
    const h5::Group h5md = h5::create_group(file, "h5md");
    h5::write_attribute(h5md.id(), "version", std::array<std::int32_t, 2>{1, 1});
    h5::write_attribute(h5::create_group(h5md.id(), "author").id(), "name", std::string("carrom"));
    const h5::Group creator = h5::create_group(h5md.id(), "creator");
    h5::write_attribute(creator.id(), "name", std::string("carrom"));
    h5::write_attribute(creator.id(), "version", program_version);
    if (system.length_unit.empty() && system.time_unit.empty()) return;
    const h5::Group modules = h5::create_group(h5md.id(), "modules"),
                    units = h5::create_group(modules.id(), "units");
    h5::write_attribute(units.id(), "version", std::array<std::int32_t, 2>{1, 0});
    h5::write_attribute(units.id(), "system", std::string("SI"));
}

/// Writes the group `box`, with its dimension and boundaries, into a group of particles.
void create_box(hid_t parent, const RecordedSystem& system) {
    const h5::Group box = h5::create_group(parent, "box");
    h5::write_attribute(box.id(), "dimension", std::array<std::int32_t, 1>{3});
    const auto boundary = [](bool is_periodic) -> std::string {
        return is_periodic ? "periodic" : "none";
    };
    h5::write_attribute(box.id(), "boundary",
                        std::vector<std::string>{boundary(system.is_periodic_x),
                                                 boundary(system.is_periodic_y), "none"});
}

/// Writes one value for each disc, without step and time (H5MD 1.1, "time-independent data"). Equal
/// values of one species follow each other, so deflate makes them small.
template <class Number>
void write_fixed(hid_t discs, const char* name, hid_t type, std::uint64_t n, Number common,
                 const std::vector<Number>& values, const std::string& unit = "") {
    const h5::Properties creation = h5::dataset_creation();
    h5::set(creation, H5Pset_fill_value, type, &common);
    const hsize_t size = n, chunk = std::min<std::uint64_t>(n, 1 << 16);
    if (!values.empty()) {
        h5::set(creation, H5Pset_chunk, 1, &chunk);
        h5::set(creation, H5Pset_deflate, 1u);
    }
    h5::Dataset dataset = h5::create_dataset(discs, name, type, {&size, 1}, creation);
    if (!values.empty())
        h5::checked(H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
                    name);
    write_unit(dataset.id(), unit);
    dataset.close(name);
}

} // namespace

void write_system(hid_t file, const RecordedSystem& system) {
    write_metadata(file, system);
    const h5::Group parameters = h5::create_group(file, "parameters");
    h5::write_scalar(parameters.id(), "radius", system.radius);
    if (system.open_boundaries != std::array<bool, 4>{}) {
        const auto& sides = system.open_boundaries;
        const std::array<std::int32_t, 4> flags = {sides[0], sides[1], sides[2], sides[3]};
        h5::write_column(parameters.id(), "open_sides", flags);
    }
    if (system.amplitudes != std::array<double, 4>{})
        h5::write_column(parameters.id(), "wall_amplitudes", system.amplitudes);
    if (system.origin != std::array<double, 2>{})
        h5::write_column(parameters.id(), "origin", system.origin);
    write_species(file, shown_species_path, system.species);
    create_box(h5::create_group(file, "/particles/discs").id(), system);
}

void write_bodies(hid_t file, const RecordedSystem& system) {
    const h5::Group discs(
        h5::checked(H5Gopen2(file, "/particles/discs", H5P_DEFAULT), "/particles/discs"));
    std::vector<double> radii, masses;
    std::vector<std::int64_t> numbers;
    for (const Species& one : system.species) {
        numbers.insert(numbers.end(), one.count, &one - system.species.data());
        radii.insert(radii.end(), one.count, one.radius);
        masses.insert(masses.end(), one.count, one.mass);
    }
    write_fixed(discs.id(), "radius", H5T_NATIVE_DOUBLE, system.n_discs, system.radius, radii,
                unit_of(system, 1, 0));
    write_fixed(discs.id(), "mass", H5T_NATIVE_DOUBLE, system.n_discs, 1.0, masses);
    write_fixed(discs.id(), "species", H5T_NATIVE_INT64, system.n_discs, std::int64_t{0}, numbers);
}

std::array<double, 3> edges_of(const Box& box) { return {box.x, box.y, 1}; }

std::string unit_of(const RecordedSystem& system, int lengths, int times) {
    std::string text;
    for (const auto& [unit, power] :
         {std::pair(&system.length_unit, lengths), std::pair(&system.time_unit, times)}) {
        if (power == 0) continue;
        if (unit->empty()) return "";
        text += (text.empty() ? "" : " ") + *unit + (power == 1 ? "" : fmt::format("{}", power));
    }
    return text;
}

void write_unit(hid_t dataset, const std::string& unit) {
    if (!unit.empty()) h5::write_any_length(dataset, "unit", unit);
}

} // namespace carrom::h5md
