// SPDX-License-Identifier: BSD-3-Clause
// Checks the energy of clusters. Discs exchange energy only in collisions, so discs linked by a
// step's collisions keep their total energy, except for what effects remove or add.
#pragma once

#include <optional>
#include <span>
#include <utility>

#include "core/disc_state.hpp"

namespace carrom {

/// A disc's squared speed, or twice its energy, before and after a step. `allowance` is the largest
/// change of this number that effects can explain.
struct SharedEnergy {
    DiscId disc = 0;
    double before = 0, after = 0;
    double allowance = 0;
    /// Number of reflections from fixed bodies; each is rounded like a collision of a pair
    double n_reflections = 0;
};

/// A cluster of discs whose energy has changed: the lowest id of its discs, the relative change,
/// and the bound on it.
struct EnergyChange {
    DiscId disc = 0;
    double share = 0, bound = 0;
};

/// Joins discs that are linked by `pairs` into clusters. Returns the cluster whose relative change
/// is largest compared with its bound, which is 64 2^-53 (rounding) for each disc, collision and
/// reflection; none if no cluster exceeds its bound. Discs that are only in `pairs` are ignored.
/// With `may_fall` clusters may lose any amount of energy.
std::optional<EnergyChange> worst_energy_change(std::span<const SharedEnergy> discs,
                                                std::span<const std::pair<DiscId, DiscId>> pairs,
                                                bool may_fall = false);

} // namespace carrom
