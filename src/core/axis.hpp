// SPDX-License-Identifier: BSD-3-Clause
// The two axes. The strips of ranks follow each other along the longer side of the box (x in a
// square), but along y in a sheared box. Cells are ordered along the same axis. Code for strips and
// cells uses coordinates along and across this axis, so the same code serves both axes.
#pragma once

#include <cstddef>
#include <utility>

#include <carrom/box.hpp>

namespace carrom {

enum class Axis : std::size_t { x = 0, y = 1 };

constexpr Axis other_axis(Axis axis) { return axis == Axis::x ? Axis::y : Axis::x; }

/// The axis of the longer side; x in a square. Strips follow each other along it, except in sheared
/// boxes.
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
