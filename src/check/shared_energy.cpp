// SPDX-License-Identifier: BSD-3-Clause
#include "check/shared_energy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace carrom {

namespace {

/// Sets of numbers; any two sets can be joined. A set is named by its lowest number.
class Clusters {
public:
    explicit Clusters(std::size_t n) : parent_(n) {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    }

    std::size_t of(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::size_t i, std::size_t j) {
        const auto [low, high] = std::minmax({of(i), of(j)});
        parent_[high] = low;
    }

private:
    std::vector<std::size_t> parent_;
};

struct Sums {
    long double before = 0, change = 0;
    double n_roundings = 0, allowance = 0;
};

} // namespace

std::optional<EnergyChange> worst_energy_change(std::span<const SharedEnergy> discs,
                                                std::span<const std::pair<DiscId, DiscId>> pairs,
                                                bool may_fall) {
    std::vector<SharedEnergy> sorted(discs.begin(), discs.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const SharedEnergy& a, const SharedEnergy& b) { return a.disc < b.disc; });
    const auto place_of = [&](DiscId id) {
        const auto found = std::lower_bound(
            sorted.begin(), sorted.end(), id,
            [](const SharedEnergy& a, DiscId b) { return a.disc < b; });
        return found != sorted.end() && found->disc == id
                   ? static_cast<std::size_t>(found - sorted.begin())
                   : sorted.size();
    };
    Clusters clusters(sorted.size());
    std::vector<double> n_collisions(sorted.size(), 0);
    for (const auto& [p, q] : pairs) {
        const std::size_t a = place_of(p), b = place_of(q);
        if (a == sorted.size() || b == sorted.size()) continue;
        n_collisions[a] += 1;
        clusters.join(a, b);
    }
    std::vector<Sums> sums(sorted.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        Sums& sum = sums[clusters.of(i)];
        sum.before += sorted[i].before;
        sum.change += static_cast<long double>(sorted[i].after) - sorted[i].before;
        sum.n_roundings += 1 + n_collisions[i] + sorted[i].n_reflections;
        sum.allowance += sorted[i].allowance;
    }
    std::optional<EnergyChange> worst;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double bound = 64 * 0x1p-53 * sums[i].n_roundings;
        const auto change = static_cast<double>(may_fall ? sums[i].change
                                                         : std::fabs(sums[i].change));
        const auto before = static_cast<double>(sums[i].before);
        if (change <= bound * before + sums[i].allowance + std::numeric_limits<double>::min())
            continue;
        const double share = change / before; // infinite if there was no energy
        if (!worst || share / bound > worst->share / worst->bound)
            worst = EnergyChange{sorted[i].disc, share, bound};
    }
    return worst;
}

} // namespace carrom
