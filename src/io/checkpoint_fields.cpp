// SPDX-License-Identifier: BSD-3-Clause
#include "io/checkpoint_fields.hpp"

#include <array>
#include <cmath>
#include <type_traits>

#include "io/checked_dataset.hpp"
#include "io/files.hpp"

namespace carrom {

hid_t type_of(const StateColumn& column) {
    return column.is_real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_UINT64;
}

void write_header(hid_t group, const CheckpointHeader& header) {
    for (const HeaderField& entry : checkpoint_header)
        std::visit([&](auto field) { h5::write_scalar(group, entry.name, header.*field); },
                   entry.field);
    if (!header.box().is_square()) h5::write_scalar(group, box_height_name, header.box_height);
    if (!header.frame.is_moving) return;
    for (const FrameField& entry : checkpoint_frame)
        h5::write_scalar(group, entry.name, header.frame.*entry.field);
    if (header.frame.period_x == 0 && header.frame.period_y == 0) return;
    for (const FrameField& entry : checkpoint_periods)
        h5::write_scalar(group, entry.name, header.frame.*entry.field);
}

CheckpointHeader read_header(hid_t file) {
    const h5::Group group(h5::checked(H5Gopen2(file, run_path, H5P_DEFAULT), run_path));
    CheckpointHeader header;
    const auto read_frame = [&](const auto& fields) {
        for (const FrameField& entry : fields)
            h5::read_scalar(group.id(), entry.name, header.frame.*entry.field);
    };
    for (const HeaderField& entry : checkpoint_header)
        std::visit([&](auto field) { h5::read_scalar(group.id(), entry.name, header.*field); },
                   entry.field);
    header.box_height = header.box_size;
    if (H5Lexists(group.id(), box_height_name, H5P_DEFAULT) > 0)
        h5::read_scalar(group.id(), box_height_name, header.box_height);
    header.frame.is_moving = H5Lexists(group.id(), checkpoint_frame[0].name, H5P_DEFAULT) > 0;
    if (header.frame.is_moving) read_frame(checkpoint_frame);
    if (H5Lexists(group.id(), checkpoint_periods[0].name, H5P_DEFAULT) > 0)
        read_frame(checkpoint_periods);
    for (std::size_t k = 0; k < n_side_columns; ++k)
        if (h5::has(file, path_of(static_cast<SideColumn>(k))))
            header.columns.add(static_cast<SideColumn>(k));
    return header;
}

void write_species(hid_t file, const std::string& path, const std::vector<Species>& species) {
    if (species.empty()) return;
    const h5::Group group = h5::create_group(file, path.c_str());
    const auto write = [&](const char* name, auto field) {
        std::vector<std::remove_cvref_t<decltype(species[0].*field)>> numbers;
        for (const Species& one : species) numbers.push_back(one.*field);
        h5::write_whole(group.id(), name, std::array<hsize_t, 1>{numbers.size()},
                        h5::type_of<typename decltype(numbers)::value_type>(), numbers.data());
    };
    write("count", &Species::count);
    write("radius", &Species::radius);
    write("mass", &Species::mass);
}

std::vector<Species> read_species(hid_t file, const std::string& path, std::uint64_t n_discs) {
    if (!h5::has(file, path)) return {};
    const auto counts = h5::read_column<std::uint64_t>(file, path + "/count");
    const auto radii = h5::read_column<double>(file, path + "/radius"),
               masses = h5::read_column<double>(file, path + "/mass");
    if (counts.size() != radii.size() || counts.size() != masses.size())
        throw FileError("its species are no such list");
    std::vector<Species> species;
    std::uint64_t n_left = n_discs;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        const Species& one = species.emplace_back(Species{counts[k], radii[k], masses[k]});
        const bool is_body = one.radius > 0 && one.mass > 0 && std::isfinite(one.radius) &&
                             std::isfinite(one.mass);
        if (one.count == 0 || one.count > n_left || !is_body)
            throw FileError("its species cannot be those of its discs");
        n_left -= one.count;
    }
    if (n_left != 0) throw FileError("its species cannot be those of its discs");
    return species;
}

void broadcast(CheckpointHeader& header, const Communicator& communicator) {
    for (const HeaderField& entry : checkpoint_header)
        std::visit([&](auto field) { communicator.broadcast(header.*field); }, entry.field);
    communicator.broadcast(header.box_height);
    communicator.broadcast(header.frame);
    communicator.broadcast(header.columns);
    communicator.broadcast(header.species);
}

} // namespace carrom
