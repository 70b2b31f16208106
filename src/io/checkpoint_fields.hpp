// SPDX-License-Identifier: BSD-3-Clause
// What a checkpoint holds beside the columns of discs (disc_columns.hpp), in tables that writer,
// reader and comparison loop over.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>

#include "core/disc_columns.hpp"
#include "io/checkpoint.hpp"
#include "io/hdf5.hpp"

namespace carrom {

inline constexpr const char* run_path = "/carrom/run";
inline constexpr const char* species_path = "/carrom/species";
/// In /carrom/format. Formats 1 and 2 began with a text instead of HDF5's signature.
inline constexpr std::int64_t checkpoint_format = 3;
inline constexpr const char* format_path = "/carrom/format";

/// Where the columns are.
inline std::string path_of(const StateColumn& column) {
    return std::string("/carrom/discs/") + column.name;
}
inline std::string path_of(SideColumn column) {
    return std::string("/carrom/discs/") + info_of(column).name;
}

/// A dataset of /carrom/run: one value.
struct HeaderField {
    const char* name;
    std::variant<std::string CheckpointHeader::*, double CheckpointHeader::*,
                 std::int64_t CheckpointHeader::*, std::uint64_t CheckpointHeader::*>
        field;
};

using H = CheckpointHeader;
inline constexpr std::array<HeaderField, 17> checkpoint_header = {
    {{"program_version", &H::program_version},
     {"scene_name", &H::scene_name},
     {"scene_text", &H::scene_text},
     {"scene_overrides", &H::scene_overrides},
     {"scene_lines_before_discs", &H::scene_lines_before_discs},
     {"scene_discs_follow", &H::scene_discs_follow},
     {"box_size", &H::box_size},
     {"radius", &H::radius},
     {"method", &H::method},
     {"micro_steps", &H::micro_steps},
     {"sync_every", &H::sync_every},
     {"step", &H::step},
     {"micro_steps_done", &H::micro_steps_done},
     {"n_discs", &H::n_discs},
     {"wall_collisions", &H::wall_collisions},
     {"pair_collisions", &H::pair_collisions},
     {"state_hash", &H::state_hash}}};

/// The same for a rectangle.
inline constexpr const char* box_height_name = "box_height";

/// The same for a frame that moves.
struct FrameField {
    const char* name;
    double Frame::* field;
};
inline constexpr std::array<FrameField, 6> checkpoint_frame = {{{"frame_x", &Frame::x},
                                                                {"frame_y", &Frame::y},
                                                                {"frame_vx", &Frame::vx},
                                                                {"frame_vy", &Frame::vy},
                                                                {"frame_slowing", &Frame::slowing},
                                                                {"frame_clock", &Frame::clock}}};

/// What measurements and trajectories go on with: one number for each disc.
struct SampleColumn {
    const char* path;
    double FirstPlace::* field;
    bool StoredSamples::* is_there;

    bool is_in(const StoredSamples& samples) const { return samples.*is_there; }
};
inline constexpr std::array<SampleColumn, 8> sample_columns = {
    {{"/carrom/measurements/first_x", &FirstPlace::x, &StoredSamples::have_first_places},
     {"/carrom/measurements/first_y", &FirstPlace::y, &StoredSamples::have_first_places},
     {"/carrom/measurements/lengths_x", &FirstPlace::lengths_x, &StoredSamples::have_lengths},
     {"/carrom/measurements/lengths_y", &FirstPlace::lengths_y, &StoredSamples::have_lengths},
     {"/carrom/measurements/first_vx", &FirstPlace::vx, &StoredSamples::have_velocities},
     {"/carrom/measurements/first_vy", &FirstPlace::vy, &StoredSamples::have_velocities},
     {"/carrom/trajectory/image_x", &FirstPlace::image_x, &StoredSamples::have_images},
     {"/carrom/trajectory/image_y", &FirstPlace::image_y, &StoredSamples::have_images}}};
/// And for one of a periodic box.
inline constexpr std::array<FrameField, 2> checkpoint_periods = {
    {{"period_x", &Frame::period_x}, {"period_y", &Frame::period_y}}};

hid_t type_of(const StateColumn& column);

void write_header(hid_t group, const CheckpointHeader& header);
/// From a file. Throws FileError where something is missing or of another kind. Leaves out species.
CheckpointHeader read_header(hid_t file);
/// Species, a column each for counts, radii and masses; nothing where there are none. Throw
/// FileError.
void write_species(hid_t file, const std::string& path, const std::vector<Species>& species);
std::vector<Species> read_species(hid_t file, const std::string& path, std::uint64_t n_discs);
/// Replaces the header on every rank by that of rank 0. **Collective.**
void broadcast(CheckpointHeader& header, const Communicator& communicator);

/// Rows that are taken apart into columns, or put together from them, at a time: 1 MiB of discs, so
/// that they stay in the L2 cache.
inline constexpr std::uint64_t rows_per_piece = 1 << 14;

} // namespace carrom
