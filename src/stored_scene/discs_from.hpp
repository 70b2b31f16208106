// SPDX-License-Identifier: BSD-3-Clause
// `discs.from`: the discs of another run's checkpoint or frame, as the lines that a
// file of discs would have. So they are checked, and sent to their ranks, like all
// listed discs. Takes some 100 bytes a disc on one rank while a run begins.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/side_columns.hpp"

namespace carrom {

struct FileOfDiscs {
    std::uint64_t n_discs = 0;
    std::string columns; ///< `discs.columns` of the lines, or empty
    std::string lines;   ///< `id x y vx vy`, per step, by id
};

/// Reads the frame of `step`, or the last one. `wanted` are columns beside the states,
/// read if the file has them. Call check_damage before. Throws InputError naming the
/// file. Not collective.
FileOfDiscs read_discs_from(const std::string& path, std::optional<std::int64_t> step,
                            const SideColumnSet& wanted);

} // namespace carrom
