// SPDX-License-Identifier: BSD-3-Clause
// `discs.from`: the discs of another run's checkpoint or frame, as the lines that a file of discs
// would have. So they are checked, and come to their ranks, as all listed discs do. Takes some 100
// bytes a disc on one rank while a run begins.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace carrom {

struct FileOfDiscs {
    std::uint64_t n_discs = 0;
    bool have_spins = false; ///< lines end in the disc's spin
    std::string lines;       ///< `id x y vx vy`, per step, by id
};

/// The frame of `step`, or the last one. `wants_spins`: those that the file has. Damage is to be
/// looked for before (check_damage). Throws InputError naming the file. Not collective.
FileOfDiscs read_discs_from(const std::string& path, std::optional<std::int64_t> step,
                            bool wants_spins);

} // namespace carrom
