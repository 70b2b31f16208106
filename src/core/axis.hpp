// SPDX-License-Identifier: BSD-3-Clause
// The two axes. The strips of ranks follow each other along the box's longer side (x in a square),
// in sheared boxes along y, and cells are ordered along the same axis. Code for strips and cells
// uses coordinates along this axis and across it, so it is the same for both axes.
#pragma once

#include <cstddef>
#include <utility>

#include <carrom/box.hpp>

namespace carrom {

enum class Axis : std::size_t { x = 0, y = 1 };

constexpr Axis other_axis(Axis axis) { return axis == Axis::x ? Axis::y : Axis::x; }

/// The axis of the longer side. Strips follow each other along it, except in sheared boxes.
constexpr Axis longer_axis(const Box& box) { return box.y > box.x ? Axis::y : Axis::x; }

template <class Number>
[[gnu::always_inline]] constexpr Number along(Axis axis, Number x, Number y) {
    return axis == Axis::x ? x : y;
}
constexpr double along(Axis axis, const Box& box) { return along(axis, box.x, box.y); }

/// Converts (x, y) to (along, across) for strips along `axis`, or (along, across) back to (x, y).
template <class Number> constexpr std::pair<Number, Number> turned(Axis axis, Number x, Number y) {
    return axis == Axis::x ? std::pair(x, y) : std::pair(y, x);
}

} // namespace carrom
