// SPDX-License-Identifier: BSD-3-Clause
// Moves the cuts between domains, so that all ranks have equal work. Strips are cut first, by the
// weights along their axis. Then each strip is cut across by the weights in it.
//
// A rank's work has been counted, with all that its halo costs. It is shared out among the rank's
// discs: each has the same part of what discs cost, and a part of what pairs cost by the number of
// others in its cell. So a cut through a crowd finds its place, and what this guesses wrong is
// counted, and put right, at the next inspection. Price: one pass over the own discs, or two, and
// sums of some thousand numbers for each direction and strip.
#include <algorithm>
#include <utility>

#include "domain/domain_cuts.hpp"
#include "domain/strip_discs.hpp"
#include "parallel/joint_reduction.hpp"

namespace carrom {

/// Calls visit(disc, weight) for each own disc. Weights are whole numbers of units, at least one.
template <class Visit>
void StripDiscs::weigh(const RankWork& work, double unit, const Visit& visit) const {
    const auto of_disc = [&](double of_discs, double of_pairs) {
        return static_cast<std::uint64_t>((of_discs + of_pairs) / unit) + 1;
    };
    const double n = static_cast<double>(std::max<std::size_t>(1, n_own_));
    const double of_discs = static_cast<double>(work.of_discs) / n,
                 of_pairs = static_cast<double>(work.of_pairs);
    std::uint64_t n_pairs = 0; // each counted twice
    const auto for_each_cell = [&](const auto& act) {
        const GridGeometry& geometry = grid_.geometry();
        for (int column = 0; column < geometry.n_columns; ++column)
            for (int row = 0; row < geometry.n_rows; ++row) act(grid_.run(column, row, row));
    };
    if (is_sorted_)
        for_each_cell([&](SlotRange cell) {
            const std::uint64_t n_here = cell.end - cell.begin;
            n_pairs += n_here * n_here - n_here;
        });
    if (n_pairs == 0) {
        for (const DiscState& disc : own()) visit(disc, of_disc(of_discs, of_pairs / n));
        return;
    }
    const double of_pair = of_pairs / static_cast<double>(n_pairs);
    for_each_cell([&](SlotRange cell) {
        if (cell.begin == cell.end) return; // what would be the weight may be negative
        const double n_others = static_cast<double>(cell.end - cell.begin) - 1;
        const std::uint64_t weight = of_disc(of_discs, of_pair * n_others);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) visit(discs_[i], weight);
    });
}

void StripDiscs::rebalance(double time, double above, const RankWork& work) {
    constexpr double units_of_disc = 0x1p20; // of a mean one
    if (communicator_.size() == 1) return;
    JointReduction all;
    all.largest = static_cast<double>(work.all());
    all.sums[0] = work.all();
    reduce(all, communicator_);
    const auto sum = static_cast<double>(all.sums[0]);
    if (all.largest * communicator_.size() <= above * sum || sum == 0) return;
    const double unit = sum / (static_cast<double>(n_total_) * units_of_disc);

    const Axis axis = domains_.axis(), axis_across = other_axis(axis);
    std::vector<std::uint64_t> weights(WeightBins::n_for(communicator_.size()), 0);
    WeightBins bins_along(along(axis, box_), weights);
    weigh(work, unit, [&](const DiscState& disc, std::uint64_t weight) {
        bins_along.add(place_in_box(disc, time).first, weight);
    });
    communicator_.sum(weights);
    const Strips strips(bins_along.cuts(group_sizes_), axis);
    if (!domains_.are_cut_across()) {
        domains_ = Domains(strips);
        return;
    }
    const std::size_t n_bins = WeightBins::n_for(domains_.largest_group());
    std::vector<std::uint64_t> of_strips(n_bins * group_sizes_.size(), 0);
    std::vector<WeightBins> bins; // by strip
    for (std::size_t k = 0; k < group_sizes_.size(); ++k)
        bins.emplace_back(along(axis_across, box_),
                          std::span(of_strips).subspan(k * n_bins, n_bins));
    weigh(work, unit, [&](const DiscState& disc, std::uint64_t weight) {
        const auto [place, across] = place_in_box(disc, time);
        bins[static_cast<std::size_t>(strips.owner(place))].add(across, weight);
    });
    communicator_.sum(of_strips);
    std::vector<Strips> groups;
    for (std::size_t k = 0; k < bins.size(); ++k) {
        const std::vector<int> ones(static_cast<std::size_t>(group_sizes_[k]), 1);
        groups.emplace_back(bins[k].cuts(ones), axis_across);
    }
    domains_ = Domains(strips, std::move(groups));
}

} // namespace carrom
