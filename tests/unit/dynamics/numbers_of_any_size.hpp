// SPDX-License-Identifier: BSD-3-Clause
// Random numbers for tests, with the same bits for every library.
#pragma once

#include <cmath>
#include <random>

namespace carrom::test {

class Numbers {
public:
    explicit Numbers(unsigned seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    /// Any order of magnitude from low to high is equally probable.
    double of_any_size(double low, double high) {
        return low * std::pow(high / low, uniform(0, 1));
    }
    int index(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }

private:
    std::mt19937_64 engine_;
};

} // namespace carrom::test
