// SPDX-License-Identifier: BSD-3-Clause
// Chooses the length of a window of the time-stepped method. In a long window more micro-steps
// share the cost of sorting discs into cells, but searches reach further. All ranks choose the same
// window, because their data are equal. The choice affects the run's time, not its bits.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include <carrom/box.hpp>

#include "core/image.hpp"

namespace carrom {

/// The distribution of speeds. Cells need not allow for a few discs that are much faster than the
/// rest.
struct SpeedSpread {
    static constexpr std::size_t n_parts = 16;
    using Counts = std::array<std::uint64_t, n_parts>;

    double largest = 0; ///< the largest speed at the time of the count
    /// The share of discs faster than k / n_parts of the largest speed
    std::array<double, n_parts> share_above{};

    SpeedSpread() = default;
    /// `counts[k]`: number of discs on all ranks with speeds from k to k + 1 parts, where a part is
    /// `largest_speed` / n_parts.
    SpeedSpread(const Counts& counts, double largest_speed);
    double speed_of(std::size_t part) const {
        return largest * static_cast<double>(part) / n_parts;
    }
    double mean() const; ///< mean speed, with an error up to largest / (2 n_parts)
};

/// The arguments of the choice: lengths in the scene's unit, speeds in lengths per micro-step.
struct WindowNeeds {
    Box box;
    double radius = 0;
    double n_discs = 0;
    double largest_speed = 0;
    double hits_per_micro_step = 0; ///< collisions per disc and micro-step, or an estimate
    double discs_per_rank = 0;
    const SpeedSpread* spread = nullptr; ///< null if the distribution of speeds is not known
};

/// Estimates the collisions per disc and micro-step from the mean speed, as for a dilute gas.
double guess_of_hits(const WindowNeeds& needs);

/// The largest distance that two discs can have at a window's anchor if they collide in the window
/// of this duration. The second form is for discs whose speed is at most `speed`.
double reach_of(const WindowNeeds& needs, double duration);
double reach_of(const WindowNeeds& needs, double duration, double speed);

/// The number of micro-steps of the next window, 1 .. n_left, or the number of parts into which the
/// next micro-step is divided.
struct WindowChoice {
    int n_micro = 1;
    int n_parts = 1;
    /// The speed that cells allow for; the few faster discs are searched for separately
    double usual_speed = 0;
};
WindowChoice choose_window(const WindowNeeds& needs, int n_left, std::optional<double> wanted);

/// The longest window in a box with periodic sides: discs at this speed fly half a period in it. In
/// longer windows many images would have to be searched. Infinite without periodic sides.
inline double longest_in_period(const Periods& periods, double speed) {
    return periods.are_any() ? periods.shortest() / (2 * speed)
                             : std::numeric_limits<double>::infinity();
}

} // namespace carrom
