// SPDX-License-Identifier: BSD-3-Clause
// Only collisions transfer energy. So discs that are linked by a step's collisions keep their total
// energy, except for what effects take or give.
#pragma once

#include <optional>
#include <span>
#include <utility>

#include "core/disc_state.hpp"

namespace carrom {

/// A disc's squared speed before and after a step, or twice its energy. `allowance` is
/// the part of it that effects may have added.
struct SharedEnergy {
    DiscId disc = 0;
    double before = 0, after = 0;
    double allowance = 0;
    /// Reflections from fixed bodies at any angle, which round like collisions of pairs
    double n_reflections = 0;
};

/// A cluster of discs whose energy has changed: its lowest disc, the share by which it changed, and
/// the bound.
struct EnergyChange {
    DiscId disc = 0;
    double share = 0, bound = 0;
};

/// The worst of the clusters that `pairs` make of `discs`; none if each kept its energy to within
/// the rounding of its collisions, 64 ulp for each disc and each collision. Discs of `pairs` that
/// are not among `discs` do not count. With `may_fall` collisions may take any energy.
std::optional<EnergyChange> worst_energy_change(std::span<const SharedEnergy> discs,
                                                std::span<const std::pair<DiscId, DiscId>> pairs,
                                                bool may_fall = false);

} // namespace carrom
