// SPDX-License-Identifier: BSD-3-Clause
// Known values of the compressibility factor of hard discs without walls.
#pragma once

#include <cmath>

namespace carrom::test {

/// Virial series to the tenth coefficient: Clisby and McCoy, J. Stat. Phys. 122, 15 (2006).
inline double virial_factor(double eta) {
    double sum = 0;
    for (const double coefficient : {10.216294, 9.272141, 8.319104, 7.351859, 6.36296, 5.336897,
                                     4.257854, 3.128018, 2.0, 1.0}) {
        sum = sum * eta + coefficient;
    }
    return sum;
}

/// Liu, arXiv:2010.10624, and Luding, Phys. Rev. E 63, 042201 (2001).
inline double liu_factor(double eta) {
    return (1 + eta * eta / 8 + std::pow(eta, 3) / 18 - 4 * std::pow(eta, 4) / 21) /
           std::pow(1 - eta, 2);
}
inline double luding_factor(double eta) {
    return 1 + 2 * eta *
                   ((1 - 7 * eta / 16) / std::pow(1 - eta, 2) -
                    std::pow(eta, 3) / 16 / (8 * std::pow(1 - eta, 4)));
}

struct KnownFactor {
    double value, error;
};
inline KnownFactor known_factor(double eta) {
    if (eta < 0.35) return {virial_factor(eta), 3e-4};
    return {(liu_factor(eta) + luding_factor(eta)) / 2,
            std::fabs(liu_factor(eta) - luding_factor(eta))};
}

} // namespace carrom::test
