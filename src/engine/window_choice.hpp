// SPDX-License-Identifier: BSD-3-Clause
// How long a window should be: long ones share the cost of sorting discs into cells, but look
// further. Pure arithmetic on numbers that all ranks know, so all choose the same. The choice
// affects the run's time, not its bits.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include <carrom/box.hpp>

#include "core/image.hpp"

namespace carrom {

/// How many discs are how fast: where few are much faster than the rest, cells need not allow for
/// those.
struct SpeedSpread {
    static constexpr std::size_t n_parts = 16;
    using Counts = std::array<std::uint64_t, n_parts>;

    double largest = 0;                        ///< no disc was faster when they were counted
    std::array<double, n_parts> share_above{}; ///< the share of discs faster than k parts of that

    SpeedSpread() = default;
    /// `counts`: discs whose speed is between k and k + 1 parts of `largest`, of all ranks.
    SpeedSpread(const Counts& counts, double largest_speed);
    double speed_of(std::size_t part) const {
        return largest * static_cast<double>(part) / n_parts;
    }
    double mean() const; ///< to within half a part
};

/// What the choice depends on: lengths in the scene's unit, speed in lengths per micro-step.
struct WindowNeeds {
    Box box;
    double radius = 0;
    double n_discs = 0;
    double largest_speed = 0;
    double hits_per_micro_step = 0; ///< how often a disc is taken, as far as is known
    double discs_per_rank = 0;
    const SpeedSpread* spread = nullptr; ///< if it is known
};

/// How often a disc will collide in a micro-step, from the mean speed in a thin gas.
double guess_of_hits(const WindowNeeds& needs);

/// How far two discs that meet inside a window of this duration can be apart at its anchor; the
/// second: if neither is faster than `speed`.
double reach_of(const WindowNeeds& needs, double duration);
double reach_of(const WindowNeeds& needs, double duration, double speed);

/// Micro-steps in the next window, 1 .. n_left, or fewer than none: how many parts to cut the next
/// micro-step into.
struct WindowChoice {
    int n_micro = 1;
    int n_parts = 1;
    double usual_speed =
        0; ///< what cells allow for; the few discs that are faster have to look around themselves
};
WindowChoice choose_window(const WindowNeeds& needs, int n_left, std::optional<double> wanted);

/// How long a window may be in a box with periodic sides: two discs do not go round it, or each
/// would be looked for in many images.
inline double longest_in_period(const Periods& periods, double speed) {
    return periods.are_any() ? periods.shortest() / (2 * speed)
                             : std::numeric_limits<double>::infinity();
}

} // namespace carrom
