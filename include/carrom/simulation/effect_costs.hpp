// SPDX-License-Identifier: BSD-3-Clause
// What each effect of a scene costs. Laws are compiled into the kernels, where nothing of an effect could be timed without
// slowing it down; so its own arithmetic is timed at the end, on discs of the run, and counted as often as discs have collided.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "carrom/core/disc.hpp"
#include "carrom/scene/scene.hpp"

namespace carrom {

struct EffectCost {
    std::string name;
    double nanoseconds_per_wall = 0; ///< more than a plain wall's, of a collision with one: its time, its bounce
    double nanoseconds_per_pair = 0; ///< more than an elastic pair's, of its impulse; negative where discs do not meet
    double bytes_per_disc = 0;       ///< of memory and of checkpoints, beyond a plain disc's
};

/// Each effect of the scene by itself, against the plain law. Takes some milliseconds for each; times depend on the machine.
/// `discs` are some of the run's, as they are stored; none, no times. Not collective.
std::vector<EffectCost> effect_costs(const Scene& scene, std::span<const Disc> discs);

/// Of `seconds` of processor time: what so many collisions have cost more. Between 0 and 1.
double time_share(const EffectCost& cost, std::uint64_t wall_collisions, std::uint64_t pair_collisions, double seconds);

} // namespace carrom
