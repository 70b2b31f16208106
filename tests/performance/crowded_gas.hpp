// SPDX-License-Identifier: BSD-3-Clause
// Gases that crowd in a corner of their box, for studies of how work is shared. The box is ten
// times as wide and high as that of an even gas, which lies in its corner.
#pragma once

#include <cstddef>
#include <vector>

#include <carrom/box.hpp>

#include "scene/scene_parameters.hpp"

namespace carrom {

enum class Crowd { none, all, half };

constexpr double stretch = 10; ///< of the box's sides where discs crowd

/// Where half of the discs crowd, every second disc of the even gas goes to a place ten times as
/// far away, and those that would fall into the corner again are left out. `corner` is the box of
/// the even gas.
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

/// The box of a gas of which some discs crowd.
inline Box box_around(const Box& corner, Crowd crowd) {
    return crowd == Crowd::none ? corner : Box{stretch * corner.x, stretch * corner.y};
}

/// A disc as it begins, with its velocity per micro-step.
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
