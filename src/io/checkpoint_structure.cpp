// SPDX-License-Identifier: BSD-3-Clause
#include "io/checkpoint_structure.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

#include <fcntl.h>

#include "io/checked_dataset.hpp"
#include "io/checkpoint_fields.hpp"
#include "io/files.hpp"
#include "io/h5md.hpp"

namespace carrom {

namespace {

constexpr const char *radius_path = "/particles/discs/radius",
                     *species_number_path = "/particles/discs/species";

/// For each species, the id after its last disc.
std::vector<DiscId> ends_of(const std::vector<Species>& species) {
    std::vector<DiscId> ends;
    for (const Species& one : species) ends.push_back((ends.empty() ? 0 : ends.back()) + one.count);
    return ends;
}

void write_unit(hid_t parent, const char* name, const std::string& unit) {
    h5md::write_unit(h5::open_checked(parent, name).id(), unit);
}

/// Makes a group for a single frame, with its step and time; the caller adds `value`.
h5::Group create_frame(hid_t parent, const char* name, const CheckpointHeader& header) {
    h5::Group group = h5::create_group(parent, name);
    h5::write_column(group.id(), "step", std::array{header.step});
    h5::write_column(group.id(), "time", std::array{static_cast<double>(header.step)});
    write_unit(group.id(), "time", h5md::unit_of(header.shown, 0, 1));
    return group;
}

/// Makes the data sets of those `targets` whose paths in the file begin with `path`.
void create_columns(hid_t file, std::string_view path, const std::vector<DiscTarget>& targets,
                    hsize_t n_discs) {
    for (const DiscTarget& target : targets) {
        if (!target.path.starts_with(path)) continue;
        const std::vector<hsize_t> row = {n_discs}, vectors = {1, n_discs, 3};
        const bool is_number = target.bytes_per_row == H5Tget_size(target.type);
        const h5::Dataset dataset = h5::create_dataset(
            file, target.path, target.type, is_number ? row : vectors, h5::allocated_creation());
        h5md::write_unit(dataset.id(), target.unit);
    }
}

void create_groups(hid_t file, const CheckpointHeader& header, const StoredSamples& samples,
                   const std::vector<DiscTarget>& targets) {
    const auto create = [&](std::string_view path) {
        create_columns(file, path, targets, header.n_discs);
    };
    h5md::write_system(file, header.shown);
    const std::array<double, 3> edges = h5md::edges_of(header.shown.box);
    h5::write_whole(create_frame(file, "/particles/discs/box/edges", header).id(), "value",
                    std::array<hsize_t, 2>{1, 3}, H5T_NATIVE_DOUBLE, edges.data());
    write_unit(file, h5md::edges_path, h5md::unit_of(header.shown, 1, 0));
    for (const char* const vectors : {"/particles/discs/position", "/particles/discs/velocity"}) {
        static_cast<void>(create_frame(file, vectors, header));
        create(vectors);
    }
    if (header.shown.species.empty()) h5md::write_bodies(file, header.shown);
    create(radius_path);
    create(species_number_path);

    const h5::Group carrom = h5::create_group(file, "carrom");
    h5::write_scalar(file, format_path, checkpoint_format);
    write_header(h5::create_group(carrom.id(), "run").id(), header);
    write_species(file, species_path, header.species);
    static_cast<void>(h5::create_group(carrom.id(), "discs"));
    create("/carrom/discs/");
    if (!samples.averages.empty()) h5::write_column(carrom.id(), "averages", samples.averages);
    if (!samples.watched.empty()) h5::write_column(carrom.id(), "watched", samples.watched);
    if (!samples.stop.empty()) h5::write_column(carrom.id(), "stop", samples.stop);
    if (!samples.effects.empty()) h5::write_column(carrom.id(), "effects", samples.effects);
    if (!samples.sums.empty()) {
        const h5::Group measurements = h5::create_group(carrom.id(), "measurements");
        h5::write_column(measurements.id(), "sums", samples.sums);
    }
    if (samples.have_images) static_cast<void>(h5::create_group(carrom.id(), "trajectory"));
    create("/carrom/measurements/");
    create("/carrom/trajectory/");
}

} // namespace

std::vector<DiscTarget> disc_targets(const CheckpointHeader& header, const StoredSamples& samples,
                                     const SideOfPieces& columns) {
    std::vector<DiscTarget> targets;
    const auto add = [&](std::string path, hid_t type, std::string unit, auto number_of) {
        constexpr std::size_t size = sizeof number_of(DiscState{});
        const auto put = [number_of](std::span<const DiscState> discs, std::byte* out) {
            for (const DiscState& disc : discs) {
                const auto number = number_of(disc);
                std::memcpy(out, &number, size);
                out += size;
            }
        };
        targets.push_back({std::move(path), type, size, std::move(unit), put});
    };
    const auto vector_of = [](double x, double y) {
        return std::array{static_cast<float>(x), static_cast<float>(y), 0.0f};
    };
    const Frame frame = header.frame;
    const double clock = header.clock(), k = static_cast<double>(header.micro_steps);
    add("/particles/discs/position/value", H5T_NATIVE_FLOAT, h5md::unit_of(header.shown, 1, 0),
        [=](const DiscState& disc) {
            const DiscState shown = frame.in_box(disc, clock);
            return vector_of(shown.x, shown.y);
        });
    add("/particles/discs/velocity/value", H5T_NATIVE_FLOAT, h5md::unit_of(header.shown, 1, -1),
        [=](const DiscState& disc) {
            const DiscState shown = frame.in_box(disc, clock);
            return vector_of(shown.vx * k, shown.vy * k);
        });
    if (!header.shown.species.empty()) {
        // Searches the list of species for each disc, because a table for all discs would take
        // memory.
        const auto number_of = [ends = ends_of(header.shown.species)](const DiscState& disc) {
            return std::upper_bound(ends.begin(), ends.end(), disc.id) - ends.begin();
        };
        add(radius_path, H5T_NATIVE_DOUBLE, h5md::unit_of(header.shown, 1, 0),
            [=, &columns, are_swapped = header.columns.has(SideColumn::swapped_radius),
             species = header.shown.species](const DiscState& disc) {
                return are_swapped ? columns.of(SideColumn::swapped_radius, disc)
                                   : species[static_cast<std::size_t>(number_of(disc))].radius;
            });
        add(species_number_path, H5T_NATIVE_INT32, "",
            [=](const DiscState& disc) { return static_cast<std::int32_t>(number_of(disc)); });
    }
    for (const StateColumn& column : disc_columns)
        targets.push_back({path_of(column), type_of(column), 8, "", column.put});
    header.columns.for_each([&](SideColumn column) {
        add(path_of(column), H5T_NATIVE_DOUBLE, "",
            [column, &columns](const DiscState& disc) { return columns.of(column, disc); });
    });
    for (const SampleColumn& column : sample_columns)
        if (samples.*column.is_there)
            add(column.path, H5T_NATIVE_DOUBLE, "",
                [&column, &places = samples.first_places](const DiscState& disc) {
                    return places[disc.id - places.front().id].*column.field;
                });
    return targets;
}

void create_structure(const std::string& path, CheckpointHeader header,
                      const StoredSamples& samples, const std::vector<DiscTarget>& targets) {
    header.wall_collisions = header.pair_collisions = 0;
    header.state_hash = to_string(StateHash{});
    Checksums sums;
    for (const DiscTarget& target : targets) sums.data.push_back({target.path, 0, 0, {}, {}});
    header.shown.n_discs = header.n_discs;
    header.shown.program_version = header.program_version;
    h5::create_file(path, [&](hid_t file) {
        create_groups(file, header, samples, targets);
        h5::write_scalar(file, checksums_path, sums.text());
    });
}

void complete(const std::string& path, const StateSums& sums) {
    h5::File file = h5::open_file(path, h5::Access::write);
    h5::overwrite(file.id(), "/carrom/run/wall_collisions", sums[place_of_collisions].low);
    h5::overwrite(file.id(), "/carrom/run/pair_collisions", sums[place_of_collisions].high / 2);
    h5::overwrite(file.id(), "/carrom/run/state_hash", to_string(sums[place_of_hash]));
    Checksums all = read_checksums(file.id());
    file.close("cannot be written");
    for (std::size_t k = 0; k < all.data.size(); ++k)
        all.data[k].checksum = sums[first_checksum + k];
    // The file is closed while this sum is computed, because HDF5 sets a mark in a file that is
    // open for writing, which would change the sum.
    all.others = checksum_of_others(path, all.left_out());
    file = h5::open_file(path, h5::Access::write);
    h5::overwrite(file.id(), checksums_path, all.text());
    file.close("cannot be written");
    Descriptor(path, O_RDWR).sync();
}

} // namespace carrom
