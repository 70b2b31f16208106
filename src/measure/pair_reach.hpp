// SPDX-License-Identifier: BSD-3-Clause
// How far correlations of pairs are measured: the setting that g(r) and g6(r) share,
// and the bins that most tables share.
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
/// Sets the distance if the scene does not: at most half the room of centres, in the
/// smallest box of the run.
void check_largest_distance(const SceneDraft& draft);
/// After a restart walls may move in less or further than before. A stored distance that was
/// not set by the scene holds if there is room for it; otherwise this throws InputError.
void keep_largest_distance(KeptNumbers& kept, const MeasuredRun& run, double& distance);

} // namespace carrom
