// SPDX-License-Identifier: BSD-3-Clause
// How long a window should be: long ones share the cost of sorting discs into cells, but look further. Pure arithmetic
// on numbers that all ranks know, so all choose the same; the choice costs or saves time and has no say in the bits.
#pragma once

#include <cstdint>
#include <optional>

namespace carrom {

/// What the choice depends on: lengths in the scene's unit, speed in lengths per micro-step.
struct WindowNeeds {
    double box_size = 0, radius = 0;
    double n_discs = 0;
    double largest_speed = 0;
    double hits_per_micro_step = 0; ///< how often a disc is taken, as far as is known
    double discs_per_rank = 0;
};

/// How far two discs that meet inside a window of this duration can be apart at its anchor.
double reach_of(const WindowNeeds& needs, double duration);

/// Micro-steps in the next window, 1 .. n_left, or fewer than none: how many parts to cut the next micro-step into.
struct WindowChoice {
    int n_micro = 1;
    int n_parts = 1;
};
WindowChoice choose_window(const WindowNeeds& needs, int n_left, std::optional<double> wanted);

} // namespace carrom
