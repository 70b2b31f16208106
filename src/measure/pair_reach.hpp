// SPDX-License-Identifier: BSD-3-Clause
// How far correlations of pairs reach: the setting that g(r) and g6(r) share, and the bins that
// most tables share.
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
/// Works out the distance where it is not given: half the room of centres at most, in the smallest
/// box that there will be.
void check_largest_distance(const Check& check);
/// At a restart walls may come in less far, or further: then a stored distance that was worked out
/// holds if there is room for it, else this throws InputError.
void keep_largest_distance(KeptNumbers& kept, const MeasuredRun& run, double& distance);

} // namespace carrom
