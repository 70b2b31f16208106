// SPDX-License-Identifier: BSD-3-Clause
#include "domain/domain_cuts.hpp"

#include <algorithm>
#include <utility>

namespace carrom {

Domains equal_domains(const Box& box, Axis axis, const std::vector<int>& group_sizes) {
    const auto equal_cuts = [](double length, const std::vector<int>& sizes) {
        int n_all = 0, n_below = 0;
        for (const int size : sizes) n_all += size;
        std::vector<double> cuts;
        for (std::size_t k = 0; k + 1 < sizes.size(); ++k)
            cuts.push_back(length * (n_below += sizes[k]) / n_all);
        return cuts;
    };
    const double width = along(other_axis(axis), box);
    std::vector<Strips> groups;
    for (const int size : group_sizes) {
        const std::vector<int> ones(static_cast<std::size_t>(size), 1);
        groups.emplace_back(equal_cuts(width, ones), other_axis(axis));
    }
    return Domains(Strips(equal_cuts(along(axis, box), group_sizes), axis), std::move(groups));
}

std::size_t WeightBins::n_for(int n_parts) {
    return std::clamp<std::size_t>(256 * static_cast<std::size_t>(n_parts), 4096, 65536);
}

void WeightBins::add(double place, std::uint64_t weight) {
    const auto n_bins = static_cast<double>(weights_.size());
    const double bin = std::clamp(place / length_ * n_bins, 0.0, n_bins - 1);
    weights_[static_cast<std::size_t>(bin)] += weight;
}

std::vector<double> WeightBins::cuts(const std::vector<int>& part_sizes) const {
    return balanced_cuts(weights_, length_, shares_below_cuts(part_sizes));
}

} // namespace carrom
