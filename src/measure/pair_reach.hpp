// SPDX-License-Identifier: BSD-3-Clause
// Settings that several tables share: the largest distance of pairs, for g(r) and g6(r), and the
// number of bins, for most tables.
#pragma once

#include "measure/measurement.hpp"

namespace carrom {

inline constexpr QuantitySetting bins_setting{"bins", 100},
    largest_distance_setting{"largest_distance"};

Key bins_key();
inline std::size_t n_bins_of(const MeasuredRun& run) {
    return static_cast<std::size_t>(bins_setting.of(run.output));
}

Key largest_distance_key();
/// Sets the largest distance if the scene does not. Checks that it is at most half the width and
/// half the height, at any time of the run, of the region that discs' centres can reach.
void check_largest_distance(const SceneDraft& draft);
/// Stores or restores the largest distance. If the scene sets it, it must not change. If walls
/// move, the default depends on the last step, and a restart may have a different one. The stored
/// distance is then used if the box stays large enough for it; otherwise this throws InputError.
void keep_largest_distance(KeptNumbers& kept, const MeasuredRun& run, double& distance);

} // namespace carrom
