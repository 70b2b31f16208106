// SPDX-License-Identifier: BSD-3-Clause
// Radii that follow a distribution: `discs.radius` as a table.
//
// Radii are not drawn: the distribution is cut into parts of equal probability, and each part is a
// species with the radius in its middle. So two seeds have the same radii, and differ by places and
// velocities only; a thousand parts tell a distribution from its limit by less than a thousandth.
// Each disc's radius and mass are found by its id, 2 bytes a disc on every rank (species.hpp).
//
// Quantiles come from a sum of the density, with + - * / and sqrt only: the same bits on every
// machine. Those of a library would differ with its error function, and so would radii.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dynamics/species.hpp"

namespace carrom {

enum class SizeKind { uniform, normal, lognormal };
enum class MassKind { area, equal };

struct SizeDistribution {
    SizeKind kind = SizeKind::uniform;
    std::optional<double> mean; ///< a length; where it is missing the packing fraction gives it
    double polydispersity = 0;  ///< standard deviation over mean, before limits cut it
    std::optional<double> smallest, largest; ///< limits, in units of the mean
    MassKind mass = MassKind::area;          ///< as the area, with 1 for a disc of the mean radius
};

/// More parts than these are not made.
constexpr std::uint64_t most_size_parts = 1000;

/// What limits the radii, in units of the mean, where the scene does not say it. Normal and
/// lognormal ones end three standard deviations from the middle.
struct SizeLimits {
    double smallest = 0, largest = 0;
};
SizeLimits size_limits(const SizeDistribution& sizes);

/// The probability of a radius between the limits, which are positive and in order. It uses the C
/// library's error function, so it serves for checks only.
double share_within_limits(const SizeDistribution& sizes);

/// Limits must hold at least this share of a distribution; so its density does not vanish there.
constexpr double smallest_share = 1e-12;

/// The radii in the middle of `n` parts of equal probability, rising, in units of the mean. The
/// limits must be positive, in order, and hold `smallest_share`. Cost: some 1e6 operations.
std::vector<double> radii_of_parts(const SizeDistribution& sizes, std::size_t n);

/// Species for so many discs, from the smallest to the largest. Where `sizes` has no mean, it is
/// the one with which they cover `covered_area`.
std::vector<Species> species_of_sizes(SizeDistribution& sizes, std::uint64_t n_discs,
                                      double covered_area);

} // namespace carrom
