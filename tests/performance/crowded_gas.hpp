// SPDX-License-Identifier: BSD-3-Clause
// Gases that are clustered in a corner of their box, for studies of shared work. The box is ten
// times as wide and high as that of the homogeneous gas, which lies in its corner.
#pragma once

#include <cstddef>
#include <vector>

#include <carrom/box.hpp>

#include "scene/scene_parameters.hpp"

namespace carrom {

enum class Crowd { none, all, half };

constexpr double stretch = 10; ///< factor of the box's sides if discs are clustered

/// Returns a clustered gas. If half of the discs are clustered, every second disc of the
/// homogeneous gas goes to a place ten times as far away, and discs that would then be in the
/// corner are left out. `corner` is the box of the homogeneous gas.
inline std::vector<InputDisc> crowded(std::vector<InputDisc> discs, const Box& corner,
                                      Crowd crowd) {
    if (crowd != Crowd::half) return discs;
    std::vector<InputDisc> kept;
    for (std::size_t k = 0; k < discs.size(); ++k) {
        InputDisc disc = discs[k];
        if (k % 2 == 0) {
            disc.x *= stretch;
            disc.y *= stretch;
            if (disc.x < 1.1 * corner.x && disc.y < 1.1 * corner.y) continue;
        }
        disc.id = kept.size();
        kept.push_back(disc);
    }
    return kept;
}

/// The box of a clustered gas.
inline Box box_around(const Box& corner, Crowd crowd) {
    return crowd == Crowd::none ? corner : Box{stretch * corner.x, stretch * corner.y};
}

/// A disc at the start, with its velocity per micro-step.
inline DiscState first_state(const InputDisc& input, const SceneParameters& scene) {
    DiscState disc;
    disc.id = input.id;
    disc.x = input.x;
    disc.y = input.y;
    disc.vx = input.vx / static_cast<double>(scene.micro_steps);
    disc.vy = input.vy / static_cast<double>(scene.micro_steps);
    return disc;
}

} // namespace carrom
