// SPDX-License-Identifier: BSD-3-Clause
#include "scene/size_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamics/drag.hpp"

namespace carrom {

namespace {

constexpr double widest_deviations = 3; ///< default |limit - middle|, in standard deviations
/// If limits are over `widest_range` standard deviations apart, cells would be too coarse. Then the
/// range is cut at `end_of_density` deviations from the middle, where the density is negligible.
constexpr double widest_range = 64, end_of_density = 12;
/// Below this polydispersity s, the rounded sum 1 + s^2 loses too many digits of s^2.
constexpr double narrow = 0x1p-13;

/// e to the power of x, with the same bits on every machine.
double exponential(double x) { return x < 0 ? drag_slowing(1, -x) : 1 / drag_slowing(1, x); }

/// The natural logarithm of `x`, by Newton's method, which ends when the change is as small as
/// rounding errors. The bits are the same on every machine.
double logarithm(double x) {
    double y = 0;
    for (int step = 0; step < 200; ++step) {
        const double change = x / exponential(y) - 1;
        y += std::clamp(change, -1.0, 1.0);
        if (std::fabs(change) < 0x1p-50) break;
    }
    return y;
}

/// The variable x in which the density is uniform or Gaussian: the radius, or its logarithm.
struct Measure {
    double middle = 1, deviation = 0;
    bool is_logarithm = false, is_flat = false;

    /// Distance from the middle in standard deviations.
    double score(double x) const { return (x - middle) / deviation; }
    double of_radius(double radius) const { return is_logarithm ? logarithm(radius) : radius; }
    double radius_of(double x) const { return is_logarithm ? exponential(x) : x; }
    double density(double x) const {
        const double z = score(x);
        return is_flat ? 1 : exponential(-z * z / 2);
    }
};

Measure measure_of(const SizeDistribution& sizes) {
    const double s = sizes.polydispersity;
    if (sizes.kind != SizeKind::lognormal) return {1, s, false, sizes.kind == SizeKind::uniform};
    // The deviation is that of the logarithm. The middle is chosen so that radii have the mean 1.
    if (s < narrow) { // the series of log(1 + s^2) keeps more digits
        const double per_square = 1 - s * s * (0.5 - s * s / 3);
        return {-s * s * per_square / 2, s * std::sqrt(per_square), true, false};
    }
    const double variance = logarithm(1 + s * s);
    return {-variance / 2, std::sqrt(variance), true, false};
}

/// The default distance of the limits from the middle, in standard deviations.
double reach_of(const SizeDistribution& sizes) {
    return sizes.kind == SizeKind::uniform ? std::sqrt(3.0) : widest_deviations;
}

} // namespace

SizeLimits size_limits(const SizeDistribution& sizes) {
    const Measure measure = measure_of(sizes);
    const double reach = reach_of(sizes);
    const double low = measure.radius_of(measure.middle - reach * measure.deviation),
                 high = measure.radius_of(measure.middle + reach * measure.deviation);
    // A uniform distribution ends at its own limits; wider limits would make it wider.
    if (sizes.kind == SizeKind::uniform)
        return {std::max(low, sizes.smallest.value_or(low)),
                std::min(high, sizes.largest.value_or(high))};
    return {sizes.smallest.value_or(low), sizes.largest.value_or(high)};
}

double share_within_limits(const SizeDistribution& sizes) {
    const auto [smallest, largest] = size_limits(sizes);
    if (sizes.polydispersity == 0) return smallest <= 1 && 1 <= largest ? 1 : 0;
    const Measure measure = measure_of(sizes);
    const double reach = reach_of(sizes);
    const auto score = [&measure](const std::optional<double>& limit, double otherwise) {
        return limit ? measure.score(measure.of_radius(*limit)) : otherwise;
    };
    const double low = score(sizes.smallest, -reach), high = score(sizes.largest, reach);
    if (measure.is_flat) return (std::min(high, reach) - std::max(low, -reach)) / (2 * reach);
    // Tails are subtracted on the side where both are small, because this keeps more digits.
    const auto tail = [](double z) { return std::erfc(z / std::numbers::sqrt2) / 2; };
    return low > 0 ? tail(low) - tail(high) : tail(-high) - tail(-low);
}

std::vector<double> radii_of_parts(const SizeDistribution& sizes, std::size_t n) {
    if (sizes.polydispersity == 0) return std::vector<double>(n, 1.0);
    const Measure measure = measure_of(sizes);
    const SizeLimits limits = size_limits(sizes);
    double low = measure.of_radius(limits.smallest), high = measure.of_radius(limits.largest);
    if (high - low > widest_range * measure.deviation) {
        low = std::max(low, measure.middle - end_of_density * measure.deviation);
        high = std::min(high, measure.middle + end_of_density * measure.deviation);
    }
    const std::size_t n_cells = 32 * n + 16384;
    const double width = (high - low) / static_cast<double>(n_cells);
    std::vector<double> up_to(n_cells + 1); // the integral of the density, by Simpson's rule
    double left = measure.density(low);
    for (std::size_t i = 0; i < n_cells; ++i) {
        const double x = low + width * static_cast<double>(i), right = measure.density(x + width);
        up_to[i + 1] = up_to[i] + (left + 4 * measure.density(x + width / 2) + right) / 6;
        left = right;
    }
    std::vector<double> radii;
    std::size_t cell = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const double wanted = up_to[n_cells] * (static_cast<double>(k) + 0.5) /
                              static_cast<double>(n);
        while (cell + 1 < n_cells && up_to[cell + 1] < wanted) ++cell;
        const double share = (wanted - up_to[cell]) / (up_to[cell + 1] - up_to[cell]);
        radii.push_back(measure.radius_of(low + width * (static_cast<double>(cell) + share)));
    }
    return radii;
}

std::vector<Species> species_of_sizes(SizeDistribution& sizes, std::uint64_t n_discs,
                                      double covered_area) {
    const std::uint64_t n_parts = std::min(n_discs, most_size_parts);
    const std::vector<double> radii = radii_of_parts(sizes, n_parts);
    std::vector<Species> species;
    double sum_of_squares = 0;
    std::uint64_t first = 0;
    for (std::uint64_t k = 0; k < n_parts; ++k) {
        const std::uint64_t end = n_discs / n_parts * (k + 1) +
                                  n_discs % n_parts * (k + 1) / n_parts;
        const double r = radii[k];
        species.push_back({end - first, r, sizes.mass == MassKind::area ? r * r : 1});
        sum_of_squares += static_cast<double>(end - first) * r * r;
        first = end;
    }
    if (!sizes.mean) sizes.mean = std::sqrt(covered_area / (std::numbers::pi * sum_of_squares));
    for (Species& one : species) one.radius *= *sizes.mean;
    return species;
}

} // namespace carrom
