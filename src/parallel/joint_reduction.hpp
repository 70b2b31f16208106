// SPDX-License-Identifier: BSD-3-Clause
// Computes several sums and one maximum over all ranks in a single reduction, because each
// reduction makes all ranks wait for the slowest.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "parallel/communicator.hpp"

namespace carrom {

/// `Counts` is a struct whose members are all std::uint64_t, so that each number has a name.
template <class Counts> struct JointReduction {
    Counts counts{};    ///< sums of counts may wrap around
    double largest = 0; ///< a number that is not NaN; -0 may become +0
};

/// The data of a reduction; unused counts are 0.
struct JointWords {
    std::array<std::uint64_t, 8> counts{};
    double largest = 0;
};

/// Replaces the counts by their sums and `largest` by its maximum over all ranks. **Collective.**
void reduce(JointWords& words, const Communicator& communicator);

/// Replaces the counts by their sums over all ranks, and the largest value by the maximum.
/// **Collective.**
template <class Counts>
void reduce(JointReduction<Counts>& values, const Communicator& communicator) {
    static_assert(std::is_trivially_copyable_v<Counts> &&
                      std::has_unique_object_representations_v<Counts> &&
                      sizeof(Counts) % sizeof(std::uint64_t) == 0,
                  "all counts are std::uint64_t");
    static_assert(sizeof(Counts) <= sizeof(JointWords::counts), "as many as a message holds");
    JointWords words;
    std::memcpy(words.counts.data(), &values.counts, sizeof values.counts);
    words.largest = values.largest;
    reduce(words, communicator);
    std::memcpy(static_cast<void*>(&values.counts), words.counts.data(), sizeof values.counts);
    values.largest = words.largest;
}

} // namespace carrom
