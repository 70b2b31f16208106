// SPDX-License-Identifier: BSD-3-Clause
// `discs.from`: reads the discs of another run's checkpoint or frame as lines of a file of discs.
// The lines are checked and sent to their ranks like all listed discs. They are generated on
// demand, at most 65536 at a time, so that no rank has to store all of them. Each rank can read the
// lines of its own share. Discs that have left their box through an open side are left out, and the
// other discs get new ids in the order of their old ids.
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/side_columns.hpp"
#include "parallel/slabs.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

struct FileOfDiscs {
    std::uint64_t n_discs = 0;           ///< number of discs that have not departed
    std::vector<std::uint64_t> departed; ///< old ids of the departed discs, ascending
    /// Number of discs of each species that have not departed, if the file has species
    std::vector<std::uint64_t> n_by_species;
    double radius = 0;   ///< radius of the largest disc in the file
    std::string columns; ///< value of `discs.columns` for further columns; empty if there are none
    /// Lines `id x y vx vy` and the numbers of `columns`, in order of the new ids. Velocities are
    /// per step. The stream can be read again. It throws if the file can no longer be read.
    std::unique_ptr<std::istream> lines;
};

/// Which lines a rank reads.
struct ShareOfDiscs {
    Slab ids;                            ///< new ids
    std::vector<std::uint64_t> departed; ///< see FileOfDiscs::departed
};

/// Positions keep the users' coordinates of the other run. If the scene has another `origin`, the
/// shift between the origins is added with rounding; otherwise positions equal those in the file.
///
/// Reads the frame of `step`, or the last frame if it is unset. `wanted`: side columns to read if
/// the file has them. Makes the lines of `share`, or of all discs if it is unset. Call check_damage
/// first. Throws an InputError that names the file. Not collective.
FileOfDiscs read_discs_from(const std::string& path, std::optional<std::int64_t> step,
                            const SideColumnSet& wanted, const Origin& origin,
                            const std::optional<ShareOfDiscs>& share = std::nullopt);

} // namespace carrom
