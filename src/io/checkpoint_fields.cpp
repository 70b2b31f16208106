// SPDX-License-Identifier: BSD-3-Clause
#include "io/checkpoint_fields.hpp"

#include <cmath>
#include <string_view>
#include <type_traits>

#include "io/checked_dataset.hpp"
#include "io/files.hpp"

namespace carrom {

namespace {

constexpr const char *box_height_name = "box_height", *scene_path = "/carrom/scene";

/// Calls `visit(name, value)` for each value of a moving frame, except its periods.
template <class SomeFrame, class Visit> void visit_frame(SomeFrame& frame, const Visit& visit) {
    visit("frame_x", frame.x);
    visit("frame_y", frame.y);
    visit("frame_vx", frame.vx);
    visit("frame_vy", frame.vy);
    visit("frame_slowing", frame.slowing);
    visit("frame_clock", frame.clock);
}
template <class SomeFrame, class Visit> void visit_periods(SomeFrame& frame, const Visit& visit) {
    visit("period_x", frame.periods.x);
    visit("period_y", frame.periods.y);
}

/// Calls `visit(name, value)` for the offset and the speed of the periodic images above the box,
/// for sheared sides.
template <class SomeFrame, class Visit> void visit_images(SomeFrame& frame, const Visit& visit) {
    visit("image_offset", frame.periods.offset);
    visit("image_speed", frame.periods.speed);
}

/// Calls `visit(name, value)` for each value of a header that a recording stores.
template <class Header, class Visit> void visit_recorded(Header& header, const Visit& visit) {
    visit_header(header, [&](std::string_view name, auto& value) {
        if (name.starts_with("scene_") || name == "n_discs") visit(name.data(), value);
    });
}

auto writer_to(hid_t group) {
    return [group](const char* name, const auto& value) { h5::write_scalar(group, name, value); };
}
auto reader_of(hid_t group) {
    return [group](const char* name, auto& value) { h5::read_scalar(group, name, value); };
}

} // namespace

hid_t type_of(const StateColumn& column) {
    return column.is_real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_UINT64;
}

void write_header(hid_t group, const CheckpointHeader& header) {
    const auto write = writer_to(group);
    visit_header(header, write);
    if (!header.box().is_square()) write(box_height_name, header.box_height);
    if (!header.frame.is_moving) return;
    visit_frame(header.frame, write);
    if (header.frame.periods.are_any()) visit_periods(header.frame, write);
    if (header.frame.periods.are_moving()) visit_images(header.frame, write);
}

CheckpointHeader read_header(hid_t file) {
    const h5::Group group(h5::checked(H5Gopen2(file, run_path, H5P_DEFAULT), run_path));
    const auto read = reader_of(group.id());
    const auto has = [&](const char* name) { return h5::has(group.id(), name); };
    CheckpointHeader header;
    visit_header(header, read);
    header.box_height = header.box_size;
    if (has(box_height_name)) read(box_height_name, header.box_height);
    header.frame.is_moving = has("frame_x");
    if (header.frame.is_moving) visit_frame(header.frame, read);
    if (has("period_x")) visit_periods(header.frame, read);
    if (has("image_speed")) visit_images(header.frame, read);
    for (const SideColumn column : all_side_columns)
        if (h5::has(file, path_of(column))) header.columns.add(column);
    return header;
}

void write_species(hid_t file, const std::string& path, const std::vector<Species>& species) {
    if (species.empty()) return;
    const h5::Group group = h5::create_group(file, path);
    const auto write = [&](const char* name, auto field) {
        std::vector<std::remove_cvref_t<decltype(species[0].*field)>> numbers;
        for (const Species& one : species) numbers.push_back(one.*field);
        h5::write_column(group.id(), name, numbers);
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

void write_recorded_run(hid_t file, const CheckpointHeader& run) {
    if (run.scene_text.empty()) return;
    visit_recorded(run, writer_to(h5::create_group(file, scene_path).id()));
    write_species(file, species_path, run.species);
}

void check_recorded_run(hid_t file, const DifferenceFrom& difference_from) {
    if (!difference_from || !h5::has(file, scene_path)) return;
    const h5::Group scene(h5::checked(H5Gopen2(file, scene_path, H5P_DEFAULT), scene_path));
    CheckpointHeader there;
    visit_recorded(there, reader_of(scene.id()));
    there.species = read_species(file, species_path, there.n_discs);
    if (const std::string difference = difference_from(there); !difference.empty())
        throw FileError("is another run's (" + difference +
                        "); name another file, or move it away");
}

} // namespace carrom
