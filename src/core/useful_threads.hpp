// SPDX-License-Identifier: BSD-3-Clause
// How many threads a number of discs keeps at work.
#pragma once

#include <algorithm>
#include <cstdint>

namespace carrom {

/// With fewer discs a thread works mostly on copies of discs of others, or only wakes and sleeps.
inline constexpr std::uint64_t least_discs_per_thread = 16;

/// At most `n_threads`, at least one.
inline int useful_threads(int n_threads, std::uint64_t n_discs) {
    const std::uint64_t useful = std::max<std::uint64_t>(1, n_discs / least_discs_per_thread);
    return static_cast<int>(std::min(static_cast<std::uint64_t>(n_threads), useful));
}

} // namespace carrom
