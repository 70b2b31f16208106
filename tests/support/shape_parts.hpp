// SPDX-License-Identifier: BSD-3-Clause
// How tests that run on several machine shapes share their runs out (tests/functions.cmake,
// IN_PARTS).
#pragma once

#include <cstdlib>
#include <optional>

namespace carrom::test {

/// The shape that these tests run on, among all that they are run on.
struct ShapePart {
    std::size_t number = 0, count = 1;
};

/// From $CARROM_TEST_PART, "number/count"; none where every shape is to make all runs.
inline std::optional<ShapePart> shape_part() {
    const char* const text = std::getenv("CARROM_TEST_PART");
    if (text == nullptr) return std::nullopt;
    char* slash = nullptr;
    const std::size_t number = std::strtoul(text, &slash, 10);
    return ShapePart{number, std::strtoul(slash + 1, nullptr, 10)};
}

/// Whether the `run`-th run is another shape's: each shape makes one of `n_sharing` that follow
/// each other, and another one each time, since runs often take turns in one respect, such as the
/// method.
inline bool is_left_to_others(std::size_t run, std::size_t n_sharing) {
    const std::optional<ShapePart> part = shape_part();
    return part && (run + run / n_sharing + part->number) % n_sharing != 0;
}

/// Whether it is when all shapes share.
inline bool is_left_to_others(std::size_t run) {
    const std::optional<ShapePart> part = shape_part();
    return part && is_left_to_others(run, part->count);
}

/// How many shapes share where `n_threads` run at once: machines of continuous integration have few
/// cores. What none of them runs is run by the long tests.
inline std::size_t n_sharing(int n_threads) { return n_threads <= 2 ? 2 : n_threads <= 4 ? 4 : 8; }

} // namespace carrom::test
