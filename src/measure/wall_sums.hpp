// SPDX-License-Identifier: BSD-3-Clause
// Sums over collisions with the four sides of the box, which two quantities have. They are exact:
// neither the order of collisions nor the rank that carries them out affects them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/exact_sum.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"

namespace carrom {

/// One sum for each side, in the order of `side_names`.
class WallSums {
public:
    /// `largest_sum` bounds the sum of any side's terms; the same on all ranks.
    explicit WallSums(double largest_sum)
        : sums_{ExactSum(largest_sum), ExactSum(largest_sum), ExactSum(largest_sum),
                ExactSum(largest_sum)} {}

    void add(std::size_t side, double term) { sums_[side].add(term); }

    /// Of all ranks. **Collective.**
    std::array<double, 4> values(const Communicator& ranks) const {
        std::array<double, 4> all{};
        for (std::size_t side = 0; side < 4; ++side) all[side] = joined(side, ranks).value();
        return all;
    }
    /// Two words of each side, over all ranks. **Collective.**
    std::vector<std::uint64_t> words(const Communicator& ranks) const {
        std::vector<std::uint64_t> all;
        for (std::size_t side = 0; side < 4; ++side) {
            const ExactSum sum = joined(side, ranks);
            all.insert(all.end(), {sum.low_word(), sum.high_word()});
        }
        return all;
    }
    void add_words(const std::uint64_t* words) {
        for (std::size_t side = 0; side < 4; ++side)
            sums_[side].add_words(words[2 * side], words[2 * side + 1]);
    }

private:
    ExactSum joined(std::size_t side, const Communicator& ranks) const {
        ExactSum sum = sums_[side];
        ranks.sum(sum);
        return sum;
    }

    std::array<ExactSum, 4> sums_;
};

/// The length of a side at a step. Between oscillating walls it is the mean.
inline double length_of_side(const Scene& scene, std::size_t side, double step) {
    const Extent box = extent_of_lines(scene.effects, scene.box, step);
    return side < 2 ? box.y_high - box.y_low : box.x_high - box.x_low;
}

} // namespace carrom
