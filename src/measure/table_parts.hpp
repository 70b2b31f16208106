// SPDX-License-Identifier: BSD-3-Clause
// Parts of tables: bins and densities.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace carrom {

inline double edge(double low, double high, std::size_t k, std::size_t n) {
    return low + (high - low) * static_cast<double>(k) / static_cast<double>(n);
}

/// A probability density: a bin's count, divided by the number of all values and the bin's width.
inline double share(std::uint64_t count, std::uint64_t all, double width) {
    return static_cast<double>(count) / (static_cast<double>(all) * width);
}

inline std::uint64_t total(const std::vector<std::uint64_t>& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

} // namespace carrom
