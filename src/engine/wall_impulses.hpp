// SPDX-License-Identifier: BSD-3-Clause
// The impulses of discs on each side of the box. Engines add to them only for a measurement. Sums
// are exact: neither the order of collisions nor the rank that carries them out affects them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/exact_sum.hpp"

namespace carrom {

struct WallImpulses {
    /// `largest_sum` bounds the sum of any side's impulses. It is the same on all
    /// ranks; mass times length per step.
    explicit WallImpulses(double largest_sum)
        : normal{ExactSum(largest_sum), ExactSum(largest_sum), ExactSum(largest_sum),
                 ExactSum(largest_sum)} {}

    /// `change` is that of the velocity across the side, away from the side that a
    /// disc has met. Axis 0 means left and right.
    void add(std::size_t axis, double change) {
        const std::size_t side = 2 * axis + (change < 0 ? 1 : 0);
        normal[side].add(change < 0 ? -change : change);
        ++counts[side];
    }

    std::array<ExactSum, 4> normal; ///< in the order of `side_names`
    std::array<std::uint64_t, 4> counts{};
};

} // namespace carrom
