// SPDX-License-Identifier: BSD-3-Clause
// The distance of a sample from its expected distribution.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace carrom::test {

/// Kolmogorov and Smirnov's largest distance of the sample's distribution from `cumulative`, times
/// sqrt(n). A sample of this distribution exceeds 1.95 once in a thousand.
template <class Cumulative>
double kolmogorov_smirnov(std::vector<double> sample, const Cumulative& cumulative) {
    std::sort(sample.begin(), sample.end());
    const double n = static_cast<double>(sample.size());
    double largest = 0;
    for (std::size_t i = 0; i < sample.size(); ++i) {
        const double expected = cumulative(sample[i]);
        largest = std::max({largest, expected - static_cast<double>(i) / n,
                            static_cast<double>(i + 1) / n - expected});
    }
    return largest * std::sqrt(n);
}

inline double mean(const std::vector<double>& sample) {
    double sum = 0;
    for (const double x : sample) sum += x;
    return sum / static_cast<double>(sample.size());
}

} // namespace carrom::test
