// SPDX-License-Identifier: BSD-3-Clause
#include "io/checkpoint_fields.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <type_traits>

#include "io/checked_dataset.hpp"
#include "io/files.hpp"

namespace carrom {

hid_t type_of(const DiscColumn& column) {
    return column.is_real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_UINT64;
}

void write_header(hid_t group, const CheckpointHeader& header) {
    for (const HeaderField& entry : checkpoint_header)
        std::visit([&](auto field) { h5::write_scalar(group, entry.name, header.*field); },
                   entry.field);
    if (!header.frame.is_moving) return;
    for (const FrameField& entry : checkpoint_frame)
        h5::write_scalar(group, entry.name, header.frame.*entry.field);
    if (header.frame.period_x == 0 && header.frame.period_y == 0) return;
    for (const FrameField& entry : checkpoint_periods)
        h5::write_scalar(group, entry.name, header.frame.*entry.field);
}

CheckpointHeader read_header(hid_t group) {
    CheckpointHeader header;
    for (const HeaderField& entry : checkpoint_header)
        std::visit([&](auto field) { h5::read_scalar(group, entry.name, header.*field); },
                   entry.field);
    header.frame.is_moving = H5Lexists(group, checkpoint_frame[0].name, H5P_DEFAULT) > 0;
    if (header.frame.is_moving)
        for (const FrameField& entry : checkpoint_frame)
            h5::read_scalar(group, entry.name, header.frame.*entry.field);
    if (H5Lexists(group, checkpoint_periods[0].name, H5P_DEFAULT) > 0)
        for (const FrameField& entry : checkpoint_periods)
            h5::read_scalar(group, entry.name, header.frame.*entry.field);
    return header;
}

bool has_spins(hid_t file) {
    return H5Lexists(file, "/carrom/discs", H5P_DEFAULT) > 0 &&
           H5Lexists(file, spin_column, H5P_DEFAULT) > 0;
}

void write_species(hid_t carrom, const std::vector<Species>& species) {
    if (species.empty()) return;
    const h5::Group group = h5::create_group(carrom, "species");
    const auto write = [&](const char* name, hid_t type, auto field) {
        std::vector<std::remove_cvref_t<decltype(species[0].*field)>> numbers;
        for (const Species& one : species) numbers.push_back(one.*field);
        h5::write_whole(group.id(), name, std::array<hsize_t, 1>{numbers.size()}, type,
                        numbers.data());
    };
    write("count", H5T_NATIVE_UINT64, &Species::count);
    write("radius", H5T_NATIVE_DOUBLE, &Species::radius);
    write("mass", H5T_NATIVE_DOUBLE, &Species::mass);
}

std::vector<Species> read_species(hid_t file, std::uint64_t n_discs) {
    if (H5Lexists(file, "/carrom/species", H5P_DEFAULT) <= 0) return {};
    std::vector<Species> species;
    const auto read = [&](const std::string& name, hid_t type, auto field) {
        const h5::Dataset column = h5::open_checked(file, "/carrom/species/" + name,
                                                    {std::nullopt});
        std::vector<std::remove_cvref_t<decltype(species[0].*field)>> numbers(
            h5::dimensions_of(column.id()).front());
        if (numbers.empty() || numbers.size() > n_discs ||
            (!species.empty() && species.size() != numbers.size()))
            throw FileError("its species are no such list");
        h5::read_rows(column.id(), {0, numbers.size()}, type, numbers.data());
        species.resize(numbers.size());
        for (std::size_t k = 0; k < numbers.size(); ++k) species[k].*field = numbers[k];
    };
    read("count", H5T_NATIVE_UINT64, &Species::count);
    read("radius", H5T_NATIVE_DOUBLE, &Species::radius);
    read("mass", H5T_NATIVE_DOUBLE, &Species::mass);
    std::uint64_t n = 0;
    for (const Species& one : species) {
        const bool is_body = one.radius > 0 && one.mass > 0 && std::isfinite(one.radius) &&
                             std::isfinite(one.mass);
        if (one.count == 0 || one.count > n_discs - n || !is_body)
            throw FileError("its species cannot be those of its discs");
        n += one.count;
    }
    if (n != n_discs) throw FileError("its species cannot be those of its discs");
    return species;
}

void broadcast(CheckpointHeader& header, const Communicator& communicator) {
    for (const HeaderField& entry : checkpoint_header)
        std::visit([&](auto field) { communicator.broadcast(header.*field); }, entry.field);
    communicator.broadcast(header.frame);
    std::uint64_t has_spins = header.has_spins ? 1 : 0;
    communicator.broadcast(has_spins);
    header.has_spins = has_spins == 1;
    communicator.broadcast(header.species);
}

} // namespace carrom
