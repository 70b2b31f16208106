// SPDX-License-Identifier: BSD-3-Clause
// Radii that follow a distribution: `discs.radius` as a table.
//
// Radii are not drawn. The distribution is cut into parts of equal probability, and each part is a
// species with the median radius of the part. So two seeds have the same radii and differ only by
// positions and velocities. With a thousand parts the cumulative distribution differs from the
// exact one by less than 0.001. Each disc's radius and mass are found by its id, with a table of 2
// bytes per disc on every rank (species.hpp).
//
// Quantiles are computed from a sum of the density, with + - * / and sqrt only, so they have the
// same bits on every machine. The error functions of libraries differ between machines, and so
// would radii.
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
    std::optional<double> mean; ///< a length; if unset, it follows from the packing fraction
    /// Standard deviation relative to the mean, before limits cut the distribution
    double polydispersity = 0;
    std::optional<double> smallest, largest; ///< limits relative to the mean
    /// Masses are proportional to areas, with mass 1 at the mean radius, or all masses are 1
    MassKind mass = MassKind::area;
};

/// The largest number of parts of equal probability, and so of species.
constexpr std::uint64_t most_size_parts = 1000;

/// The limits of radii, in units of the mean. By default, normal and lognormal distributions are
/// cut three standard deviations from the middle.
struct SizeLimits {
    double smallest = 0, largest = 0;
};
SizeLimits size_limits(const SizeDistribution& sizes);

/// The probability of a radius between the limits, which must be positive and ascending. Only for
/// checks, because it uses the error function of the C library.
double share_within_limits(const SizeDistribution& sizes);

/// Limits must contain at least this share of a distribution, so that the density between them does
/// not vanish.
constexpr double smallest_share = 1e-12;

/// The median radii of `n` parts of equal probability, ascending, in units of the mean. The limits
/// must be positive, ascending, and contain `smallest_share`. Cost: some 1e6 operations for all.
std::vector<double> radii_of_parts(const SizeDistribution& sizes, std::size_t n);

/// Species for this number of discs, from the smallest to the largest radius. If `sizes` has no
/// mean, the mean is chosen so that the discs cover `covered_area`.
std::vector<Species> species_of_sizes(SizeDistribution& sizes, std::uint64_t n_discs,
                                      double covered_area);

} // namespace carrom
