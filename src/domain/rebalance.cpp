// SPDX-License-Identifier: BSD-3-Clause
// Moves the cuts between domains, so that all ranks get equal work. First the box is cut into
// strips, by the work along the axis. Then each strip is cut across, by the work in the strip.
//
// The engine counts the work that each rank does for its own discs and its halo. This work is
// divided among the rank's discs: each gets the same part of the work for single discs, and a part
// of the work for pairs in proportion to the number of other discs in its cell. So a cut can pass
// through a cluster. Errors of this estimate show in the next count, and the next cuts correct
// them. Cost: one or two passes over the own discs, and sums of some thousand numbers for each
// direction and strip.
#include <algorithm>

#include "domain/domain_cuts.hpp"
#include "domain/strip_discs.hpp"
#include "parallel/joint_reduction.hpp"

namespace carrom {

/// Calls visit(disc, weight) for each own disc. The weight is the work for the disc in multiples of
/// `unit`, and at least 1.
template <class Visit>
void StripDiscs::weigh(const RankWork& work, double unit, const Visit& visit) const {
    const auto of_disc = [&](double of_discs, double of_pairs) {
        return static_cast<std::uint64_t>((of_discs + of_pairs) / unit) + 1;
    };
    const double n = static_cast<double>(std::max<std::size_t>(1, n_own_));
    const double of_discs = static_cast<double>(work.of_discs) / n,
                 of_pairs = static_cast<double>(work.of_pairs);
    std::uint64_t n_pairs = 0; // each pair is counted twice
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
        if (cell.begin == cell.end) return; // because n_others would be negative
        const double n_others = static_cast<double>(cell.end - cell.begin) - 1;
        const std::uint64_t weight = of_disc(of_discs, of_pair * n_others);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) visit(discs_[i], weight);
    });
}

void StripDiscs::rebalance(double time, double above, const RankWork& work) {
    constexpr double units_of_disc = 0x1p20; // weight of a disc with the mean work
    if (communicator_.size() == 1) return;
    struct Work {
        std::uint64_t of_all = 0;
    };
    JointReduction<Work> all{{work.all()}, static_cast<double>(work.all())};
    reduce(all, communicator_);
    const auto sum = static_cast<double>(all.counts.of_all);
    if (all.largest * communicator_.size() <= above * sum || sum == 0) return;
    const double unit = sum / (static_cast<double>(n_total_) * units_of_disc);
    domains_ = domains_of_equal_weights(
        communicator_, box_, domains_.axis(), group_sizes_, [&](const auto& visit) {
            weigh(work, unit, [&](const DiscState& disc, std::uint64_t weight) {
                const auto [along, across] = place_in_box(disc, time);
                visit(along, across, weight);
            });
        });
}

} // namespace carrom
