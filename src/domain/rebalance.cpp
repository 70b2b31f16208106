// SPDX-License-Identifier: BSD-3-Clause
// Moves the cuts between domains. Strips are cut first, by the weights along their axis. Then each
// strip is cut across by the weights in it. Price: one pass over the own discs, or two, and sums of
// some thousand numbers for each direction and strip.
#include <algorithm>
#include <utility>

#include "domain/domain_cuts.hpp"
#include "domain/strip_discs.hpp"

namespace carrom {

void StripDiscs::rebalance(double time, double above) {
    const auto n_ranks = static_cast<std::uint64_t>(communicator_.size());
    if (n_ranks == 1) return;
    const auto largest_share = static_cast<double>(communicator_.max(std::uint64_t{n_own_}) *
                                                   n_ranks);
    if (largest_share <= above * static_cast<double>(n_total_)) return;
    const Axis axis = domains_.axis();
    std::vector<std::uint64_t> weights(WeightBins::n_for(communicator_.size()), 0);
    WeightBins bins(along(axis, box_), weights);
    for (const DiscState& disc : own()) bins.add(place_in_box(disc, time).first, 1);
    communicator_.sum(weights);
    Strips strips(bins.cuts(group_sizes_), axis);
    domains_ = domains_.are_cut_across() ? cut_across(std::move(strips), time)
                                         : Domains(std::move(strips));
}

/// **Collective.**
Domains StripDiscs::cut_across(Strips strips, double time) const {
    const Axis axis = other_axis(strips.axis());
    const int most = *std::max_element(group_sizes_.begin(), group_sizes_.end());
    const std::size_t n_bins = WeightBins::n_for(most);
    std::vector<std::uint64_t> weights(n_bins * group_sizes_.size(), 0);
    std::vector<WeightBins> bins; // by strip
    for (std::size_t k = 0; k < group_sizes_.size(); ++k)
        bins.emplace_back(along(axis, box_), std::span(weights).subspan(k * n_bins, n_bins));
    for (const DiscState& disc : own()) {
        const auto [place, across] = place_in_box(disc, time);
        bins[static_cast<std::size_t>(strips.owner(place))].add(across, 1);
    }
    communicator_.sum(weights);
    std::vector<Strips> groups;
    for (std::size_t k = 0; k < bins.size(); ++k) {
        const std::vector<int> ones(static_cast<std::size_t>(group_sizes_[k]), 1);
        groups.emplace_back(bins[k].cuts(ones), axis);
    }
    return Domains(std::move(strips), std::move(groups));
}

} // namespace carrom
