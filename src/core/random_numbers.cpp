// SPDX-License-Identifier: BSD-3-Clause
#include "core/random_numbers.hpp"

#include <cmath>

#include <Random123/philox.h>

namespace carrom {

std::array<std::uint64_t, 4> random_words(std::uint64_t seed, Purpose purpose, DiscId id,
                                          std::uint64_t attempt, std::uint64_t block) {
    const r123::Philox4x64::ctr_type counter = {{id, attempt, block, 0}};
    const r123::Philox4x64::key_type key = {{seed, static_cast<std::uint64_t>(purpose)}};
    const r123::Philox4x64::ctr_type words = r123::Philox4x64{}(counter, key);
    return {words[0], words[1], words[2], words[3]};
}

double DiscRandom::uniform() {
    if (used_ == words_.size()) {
        words_ = random_words(seed_, purpose_, id_, occasion_, block_++);
        used_ = 0;
    }
    return unit_number(words_[used_++]);
}

Direction random_direction(DiscRandom& random) {
    for (;;) {
        const double x = 2 * random.uniform() - 1;
        const double y = 2 * random.uniform() - 1;
        const double square = x * x + y * y;
        if (square > 1 || square < 0x1p-20)
            continue; // very short vectors give an inaccurate direction
        const double length = std::sqrt(square);
        return {x / length, y / length};
    }
}

NormalPair random_normals(DiscRandom& random) {
    const double distance = std::sqrt(2 * random_exponential(random));
    const Direction direction = random_direction(random);
    return {distance * direction.x, distance * direction.y};
}

double random_exponential(DiscRandom& random) {
    // After a first number x, numbers are drawn while they descend, x >= u2 >= u3 >= ... The index
    // of the first number above its predecessor is even with probability 1 - x + x^2/2! - ... =
    // exp(-x). Each odd index is a failure and adds 1 to `whole`, so the density of x + whole is
    // exp(-(x + whole)).
    for (double whole = 0;; whole += 1) {
        const double first = random.uniform();
        double last = first;
        bool rises_at_even = true;
        for (;;) {
            const double next = random.uniform();
            if (next > last) break;
            last = next;
            rises_at_even = !rises_at_even;
        }
        if (rises_at_even) return whole + first;
    }
}

} // namespace carrom
