// SPDX-License-Identifier: BSD-3-Clause
// `discs.from`: the discs of another run's checkpoint or frame, as the lines that a
// file of discs would have. So they are checked, and sent to their ranks, like all
// listed discs. The lines are made as they are read, some thousands at a time, so that no rank
// holds those of all discs. Each rank can read those of its own share. Discs that have left their
// box by an open side are left out, and the others are numbered anew in the order of their ids.
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
    std::uint64_t n_discs = 0;           ///< without those that have departed
    std::vector<std::uint64_t> departed; ///< ids in the file of those that are left out, ascending
    std::vector<std::uint64_t> n_by_species; ///< of those that are there, if the file has species
    double radius = 0;                       ///< of the largest disc in the file
    std::string columns;                     ///< `discs.columns` of the lines, or empty
    /// `id x y vx vy`, per step, by id. Can be read again from its beginning. A file that can no
    /// longer be read makes it throw.
    std::unique_ptr<std::istream> lines;
};

/// The lines that a rank reads.
struct ShareOfDiscs {
    Slab ids;                            ///< in the new numbering
    std::vector<std::uint64_t> departed; ///< see FileOfDiscs
};

/// Places keep the coordinates that the other run shows, so they differ from those in the file
/// where `origin` of the scene is another one: by a sum that rounds, and by nothing where it is the
/// same.
///
/// Finds the frame of `step`, or the last one. `wanted` are columns beside the states,
/// read if the file has them. The lines are those of `share`, or else of all discs. Call
/// check_damage before. Throws InputError naming the file. Not collective.
FileOfDiscs read_discs_from(const std::string& path, std::optional<std::int64_t> step,
                            const SideColumnSet& wanted, const Origin& origin,
                            const std::optional<ShareOfDiscs>& share = std::nullopt);

} // namespace carrom
