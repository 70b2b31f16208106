// SPDX-License-Identifier: BSD-3-Clause
// Pairs of discs whose contact is known beforehand, by their distance, their speed, and how near
// the contact is to a graze.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace carrom::test {

struct Approach {
    double dx = 0, dy = 0, wx = 0, wy = 0, sigma = 1;
};

class Approaches {
public:
    explicit Approaches(std::uint64_t seed) : engine_(seed) {}

    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    double log_uniform(double low, double high) {
        return low * std::pow(high / low, uniform(0, 1));
    }
    int whole(int low, int high) {
        return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
    }

    /// Distance in diameters; the line of flight passes at (1 - margin) sigma, so a negative margin
    /// is a miss.
    Approach make(double distance, double margin, double speed, double sigma) {
        const double angle = uniform(0, 6.283185307179586);
        const double ex = std::cos(angle), ey = std::sin(angle);
        const double sine = std::fmin(1, (1 - margin) / distance) * (whole(0, 1) == 0 ? 1 : -1);
        const double cosine = std::sqrt((1 - sine) * (1 + sine));
        return {distance * sigma * ex, distance * sigma * ey,
                speed * sigma * (-cosine * ex - sine * ey),
                speed * sigma * (-cosine * ey + sine * ex), sigma};
    }

    /// Any pair: 1 to 1e6 diameters apart, or touching to within some ulp, with margins of 1e-14 to
    /// 1 on either side of a graze.
    Approach any() {
        const bool is_touching = whole(0, 3) == 0;
        const double distance = is_touching ? 1 + whole(-8, 8) * 0x1p-53 : log_uniform(1, 1e6);
        const double margin = log_uniform(1e-14, 1) * (whole(0, 4) == 0 ? -1 : 1);
        // One statement each, because arguments may be evaluated in any order.
        const double speed = log_uniform(0x1p-7, 0x1p7), sigma = uniform(0.5, 2);
        return make(distance, margin, speed, sigma);
    }

private:
    std::mt19937_64 engine_;
};

} // namespace carrom::test
