// SPDX-License-Identifier: BSD-3-Clause
// The box that discs move in: [0, x] x [0, y].
#pragma once

#include <algorithm>

namespace carrom {

/// Lengths of the box's sides. If only one length is given, the box is a square.
struct Box {
    double x = 0, y = 0;

    constexpr Box() = default;
    constexpr Box(double side) : x(side), y(side) {} // NOLINT: one length makes a square
    constexpr Box(double width, double height) : x(width), y(height) {}

    constexpr bool is_square() const { return x == y; }
    constexpr double longest() const { return std::max(x, y); }
    constexpr double shortest() const { return std::min(x, y); }
    constexpr double area() const { return x * y; }

    friend constexpr bool operator==(const Box&, const Box&) = default;
};

} // namespace carrom
