// SPDX-License-Identifier: BSD-3-Clause
// Lists of a checkpoint's values and of its columns for measurements, over which writer and reader
// loop. The columns of the state are in disc_columns.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "core/disc_columns.hpp"
#include "io/checkpoint.hpp"
#include "io/hdf5.hpp"

namespace carrom {

inline constexpr const char* run_path = "/carrom/run";
inline constexpr const char* species_path = "/carrom/species";
/// The number in /carrom/format. Formats 1 and 2 began with a text, before HDF5's signature.
inline constexpr std::int64_t checkpoint_format = 3;
inline constexpr const char* format_path = "/carrom/format";

/// The path of a column in the file.
inline std::string path_of(const StateColumn& column) {
    return std::string("/carrom/discs/") + column.name;
}
inline std::string path_of(SideColumn column) {
    return std::string("/carrom/discs/") + info_of(column).name;
}

/// Calls `visit(name, value)` for each dataset of /carrom/run that all checkpoints have. Each
/// dataset contains one value.
template <class Header, class Visit> void visit_header(Header& header, const Visit& visit) {
    visit("program_version", header.program_version);
    visit("scene_name", header.scene_name);
    visit("scene_text", header.scene_text);
    visit("scene_overrides", header.scene_overrides);
    visit("scene_lines_before_discs", header.scene_lines_before_discs);
    visit("scene_discs_follow", header.scene_discs_follow);
    visit("box_size", header.box_size);
    visit("radius", header.radius);
    visit("method", header.method);
    visit("micro_steps", header.micro_steps);
    visit("sync_every", header.sync_every);
    visit("step", header.step);
    visit("micro_steps_done", header.micro_steps_done);
    visit("n_discs", header.n_discs);
    visit("wall_collisions", header.wall_collisions);
    visit("pair_collisions", header.pair_collisions);
    visit("state_hash", header.state_hash);
}

/// A column with one number for each disc, which measurements or trajectories need after a restart.
struct SampleColumn {
    const char* path;
    double FirstPlace::* field;
    bool StoredSamples::* is_there;
    double most; ///< largest valid |value|; in units of the longer box edge if `in_sides`
    bool in_sides = false;
};
inline constexpr double largest_double = std::numeric_limits<double>::max();
inline constexpr std::array<SampleColumn, 8> sample_columns = {
    {{"/carrom/measurements/first_x", &FirstPlace::x, &StoredSamples::have_first_places, 2, true},
     {"/carrom/measurements/first_y", &FirstPlace::y, &StoredSamples::have_first_places, 2, true},
     {"/carrom/measurements/lengths_x", &FirstPlace::lengths_x, &StoredSamples::have_lengths,
      0x1p21},
     {"/carrom/measurements/lengths_y", &FirstPlace::lengths_y, &StoredSamples::have_lengths,
      0x1p21},
     {"/carrom/measurements/first_vx", &FirstPlace::vx, &StoredSamples::have_velocities,
      largest_double},
     {"/carrom/measurements/first_vy", &FirstPlace::vy, &StoredSamples::have_velocities,
      largest_double},
     {"/carrom/trajectory/image_x", &FirstPlace::image_x, &StoredSamples::have_images, most_images},
     {"/carrom/trajectory/image_y", &FirstPlace::image_y, &StoredSamples::have_images,
      most_images}}};

hid_t type_of(const StateColumn& column);

void write_header(hid_t group, const CheckpointHeader& header);
/// Reads a header without species. Throws FileError if a value is missing or of the wrong type.
CheckpointHeader read_header(hid_t file);
/// Write and read species as three columns, for counts, radii and masses. They write and return
/// nothing if there are no species. Both throw FileError.
void write_species(hid_t file, const std::string& path, const std::vector<Species>& species);
std::vector<Species> read_species(hid_t file, const std::string& path, std::uint64_t n_discs);

/// Writes the description of a recording's run, so that no other run can continue the recording:
/// the scene's text as in checkpoints, and the species from a file of discs. Writes nothing if
/// `run` has no scene text. Throws FileError.
void write_recorded_run(hid_t file, const CheckpointHeader& run);
/// Throws FileError if the file describes its run and `difference_from` finds a difference.
void check_recorded_run(hid_t file, const DifferenceFrom& difference_from);

/// Number of rows that are packed or unpacked at a time: 1 MiB of discs, which stays in the L2
/// cache.
inline constexpr std::uint64_t rows_per_piece = 1 << 14;

} // namespace carrom
