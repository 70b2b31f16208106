// SPDX-License-Identifier: BSD-3-Clause
// Cuts the box into one domain for each rank: at first with equal areas, later with equal work.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/axis.hpp"
#include "domain/domains.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// Domains of equal areas; strip k is divided into `group_sizes[k]` domains.
Domains equal_domains(const Box& box, Axis axis, const std::vector<int>& group_sizes);

/// Histogram of weights over [0, length] with equal bins.
class WeightBins {
public:
    /// A number of bins that is sufficient to cut the weight into `n_parts` equal parts.
    static std::size_t n_for(int n_parts);
    /// `weights` must outlive this object.
    WeightBins(double length, std::span<std::uint64_t> weights)
        : length_(length), weights_(weights) {}

    void add(double place, std::uint64_t weight);
    /// The cuts that divide the weight in proportion to `part_sizes`.
    std::vector<double> cuts(const std::vector<int>& part_sizes) const;

private:
    double length_;
    std::span<std::uint64_t> weights_;
};

/// Domains of about equal weights; strip k is divided into `group_sizes[k]` domains.
/// `for_each(visit)` calls visit(along, across, weight) for each of this rank's discs, with its
/// position in the box. `for_each` is called twice if strips are cut across. **Collective.**
template <class ForEach>
Domains domains_of_equal_weights(const Communicator& communicator, const Box& box, Axis axis,
                                 const std::vector<int>& group_sizes, const ForEach& for_each) {
    std::vector<std::uint64_t> weights(WeightBins::n_for(communicator.size()), 0);
    WeightBins bins_along(along(axis, box), weights);
    for_each([&](double place, double, std::uint64_t weight) { bins_along.add(place, weight); });
    communicator.sum(weights);
    Strips strips(bins_along.cuts(group_sizes), axis);
    const int largest_group = *std::max_element(group_sizes.begin(), group_sizes.end());
    if (largest_group == 1) return Domains(std::move(strips));
    const std::size_t n_bins = WeightBins::n_for(largest_group);
    std::vector<std::uint64_t> of_strips(n_bins * group_sizes.size(), 0);
    std::vector<WeightBins> bins; // for each strip, the weights across the strip
    for (std::size_t k = 0; k < group_sizes.size(); ++k)
        bins.emplace_back(along(other_axis(axis), box),
                          std::span(of_strips).subspan(k * n_bins, n_bins));
    for_each([&](double place, double across, std::uint64_t weight) {
        bins[static_cast<std::size_t>(strips.owner(place))].add(across, weight);
    });
    communicator.sum(of_strips);
    std::vector<Strips> groups;
    for (std::size_t k = 0; k < bins.size(); ++k) {
        const std::vector<int> ones(static_cast<std::size_t>(group_sizes[k]), 1);
        groups.emplace_back(bins[k].cuts(ones), other_axis(axis));
    }
    return Domains(std::move(strips), std::move(groups));
}

} // namespace carrom
