// SPDX-License-Identifier: BSD-3-Clause
// How tests that run on several machine shapes divide their runs among them (tests/functions.cmake,
// IN_PARTS).
#pragma once

#include <cstdlib>
#include <optional>

namespace carrom::test {

/// The number of this machine shape among all shapes on which these tests run.
struct ShapePart {
    std::size_t number = 0, count = 1;
};

/// The part in $CARROM_TEST_PART, "number/count"; nothing if every shape makes all runs.
inline std::optional<ShapePart> shape_part() {
    const char* const text = std::getenv("CARROM_TEST_PART");
    if (text == nullptr) return std::nullopt;
    char* slash = nullptr;
    const std::size_t number = std::strtoul(text, &slash, 10);
    return ShapePart{number, std::strtoul(slash + 1, nullptr, 10)};
}

/// Whether run number `run` belongs to another shape. Each shape makes one of `n_sharing`
/// successive runs, and another one each time, because successive runs often alternate in one
/// respect, such as the method.
inline bool is_left_to_others(std::size_t run, std::size_t n_sharing) {
    const std::optional<ShapePart> part = shape_part();
    return part && (run + run / n_sharing + part->number) % n_sharing != 0;
}

/// Like the function above, for runs that all shapes share.
inline bool is_left_to_others(std::size_t run) {
    const std::optional<ShapePart> part = shape_part();
    return part && is_left_to_others(run, part->count);
}

/// The number of shapes that share runs if `n_threads` run at once, because machines of continuous
/// integration have few cores. The long tests make the remaining runs.
inline std::size_t n_sharing(int n_threads) { return n_threads <= 2 ? 2 : n_threads <= 4 ? 4 : 8; }

} // namespace carrom::test
