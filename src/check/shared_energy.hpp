// SPDX-License-Identifier: BSD-3-Clause
// Energy is handed on by collisions only: discs that are linked by a step's collisions keep what
// they have together, but for what an effect takes or gives.
#pragma once

#include <optional>
#include <span>
#include <utility>

#include "core/disc.hpp"

namespace carrom {

/// A disc's squared speed before and after a step, or twice its energy; `allowance` is what effects
/// may have added of that.
struct SharedEnergy {
    DiscId disc = 0;
    double before = 0, after = 0;
    double allowance = 0;
    double n_reflections =
        0; ///< from obstacles at any angle, which round as collisions of pairs do
};

/// A cluster of discs whose energy has changed: its lowest disc, the share by which it changed, and
/// the bound.
struct EnergyChange {
    DiscId disc = 0;
    double share = 0, bound = 0;
};

/// The worst of the clusters that `pairs` make of `discs`. There is none if each kept its energy to
/// within the rounding of its collisions, 64 ulp for each disc and each collision. Discs of `pairs`
/// that are not among `discs` are left out. `may_fall`: collisions may take any energy.
std::optional<EnergyChange> worst_energy_change(std::span<const SharedEnergy> discs,
                                                std::span<const std::pair<DiscId, DiscId>> pairs,
                                                bool may_fall = false);

} // namespace carrom
