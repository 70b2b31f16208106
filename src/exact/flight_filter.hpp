// SPDX-License-Identifier: BSD-3-Clause
// First rejection of partners in a replay, many lanes at a time: which flights of some runs of slots might touch a given
// one between now and the window's end. It may keep pairs that never touch; it never loses one that does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "carrom/collision/cell_grid.hpp"

namespace carrom {

/// A disc in flight: position in cells at the time `now`, cells per window. Times run from 0 to 1 in a window.
struct Flight {
    float x = 0, y = 0, vx = 0, vy = 0;
    float now = 0;
};

/// Writes the slots of `runs` that might come within the square root of `touching_squared` of `flight`; returns how
/// many. Lanes hold positions extrapolated to the window's start. `out` has room for all slots of the runs and
/// `filter_padding` more; lanes can be read as far beyond the last slot.
std::size_t filter_flights(const FlightLanes& lanes, std::span<const SlotRange> runs, const Flight& flight,
                           float touching_squared, std::uint32_t* out);

} // namespace carrom
