// SPDX-License-Identifier: BSD-3-Clause
#include "domain/strips.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/errors.hpp"

namespace carrom {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

Strips::Strips(std::vector<double> cuts, Axis axis) : cuts_(std::move(cuts)), axis_(axis) {
    ensure(std::is_sorted(cuts_.begin(), cuts_.end()),
           "the cuts between strips are not in ascending order");
    ensure(std::all_of(cuts_.begin(), cuts_.end(), [](double cut) { return std::isfinite(cut); }),
           "a cut between strips is not a finite number");
}

Strips Strips::stretched(double factor) const {
    std::vector<double> cuts = cuts_;
    for (double& cut : cuts) cut *= factor;
    return Strips(std::move(cuts), axis_);
}

double Strips::low(int rank) const {
    return rank == 0 ? -infinity : cuts_[static_cast<std::size_t>(rank) - 1];
}

double Strips::high(int rank) const {
    return rank + 1 == size() ? infinity : cuts_[static_cast<std::size_t>(rank)];
}

int Strips::owner(double x) const {
    return static_cast<int>(std::upper_bound(cuts_.begin(), cuts_.end(), x) - cuts_.begin());
}

std::vector<int> Strips::neighbours_within(int rank, double reach) const {
    std::vector<int> neighbours;
    if (is_empty(rank)) return neighbours;
    for (int lower = rank - 1; lower >= 0 && are_within(of(lower), of(rank), reach); --lower)
        if (!is_empty(lower)) neighbours.push_back(lower);
    std::reverse(neighbours.begin(), neighbours.end());
    for (int upper = rank + 1; upper < size() && are_within(of(rank), of(upper), reach); ++upper)
        if (!is_empty(upper)) neighbours.push_back(upper);
    return neighbours;
}

bool can_move(const Strip& before, const Strip& after, double distance) {
    return before.high + distance >= after.low && before.low - distance < after.high;
}

bool are_within(const Strip& a, const Strip& b, double reach) {
    // This must be true if a sender in `a` would choose `b` for a disc at x, by comparisons of
    // rounded numbers. If `a` is below `b`, the rounded x + reach is at most the rounded a.high +
    // reach, because rounding is monotone. If `a` is above `b` and the rounded x - reach is less
    // than b.high, the rounded b.high + reach is at least x. The difference of two edges could be
    // rounded the wrong way.
    return a.high + reach >= b.low && b.high + reach >= a.low;
}

std::vector<double> balanced_cuts(std::span<const std::uint64_t> weights, double length,
                                  std::span<const double> below_cuts) {
    const double total = static_cast<double>(
        std::accumulate(weights.begin(), weights.end(), std::uint64_t{0}));
    const double bin_width = length / static_cast<double>(std::max<std::size_t>(1, weights.size()));
    std::vector<double> cuts;
    std::size_t bin = 0;
    double below = 0; // total weight before `bin`, an integer: exact up to 2^53
    for (const double share : below_cuts) {
        double cut = length * share;
        if (total > 0) {
            const double target = total * share;
            while (bin + 1 < weights.size() && below + static_cast<double>(weights[bin]) < target)
                below += static_cast<double>(weights[bin++]);
            const double in_bin = weights[bin] > 0
                                      ? (target - below) / static_cast<double>(weights[bin])
                                      : 0;
            cut = bin_width * (static_cast<double>(bin) + std::clamp(in_bin, 0.0, 1.0));
        }
        cuts.push_back(std::clamp(cut, cuts.empty() ? 0.0 : cuts.back(), length));
    }
    return cuts;
}

} // namespace carrom
