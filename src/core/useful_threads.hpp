// SPDX-License-Identifier: BSD-3-Clause
// How many threads are useful for a given number of discs.
#pragma once

#include <algorithm>
#include <cstdint>

namespace carrom {

/// With fewer discs per thread, threads would spend most of their time copying other threads'
/// discs, or waking up and going to sleep.
inline constexpr std::uint64_t least_discs_per_thread = 16;

/// The number of threads to use: at most `n_threads`, at least one.
inline int useful_threads(int n_threads, std::uint64_t n_discs) {
    const std::uint64_t useful = std::max<std::uint64_t>(1, n_discs / least_discs_per_thread);
    return static_cast<int>(std::min(static_cast<std::uint64_t>(n_threads), useful));
}

} // namespace carrom
