// SPDX-License-Identifier: BSD-3-Clause
#include "domain/domains.hpp"

#include <algorithm>
#include <limits>

#include "core/errors.hpp"

namespace carrom {

namespace {

/// Groups of ranks are used only if they reduce a rank's mean number of own and halo discs to less
/// than the share `worth_a_group` of the number with whole strips, and by at least `least_saved`,
/// because copying that many discs takes as long as messages to six more neighbours.
constexpr double worth_a_group = 0.95, least_saved = 600;

/// The mean over ranks of the area of domain and halo, divided by the area of the domain. Halos end
/// at walls.
double share_seen(const GroupNeeds& needs, int n_strips) {
    const double n_across = static_cast<double>(needs.n_ranks) / n_strips;
    const auto seen = [&](double length, double parts, bool is_periodic) {
        const double sides = is_periodic ? parts : parts - 1;
        const double share = 1 + 2 * needs.halo * sides / length;
        return is_periodic ? share : std::min(share, parts);
    };
    return seen(needs.length, n_strips, needs.is_periodic) *
           seen(needs.width, n_across, needs.is_periodic_across);
}

std::vector<int> even_groups(int n_ranks, int n_strips) {
    std::vector<int> sizes;
    for (std::int64_t k = 0; k < n_strips; ++k)
        sizes.push_back(static_cast<int>((k + 1) * n_ranks / n_strips - k * n_ranks / n_strips));
    return sizes;
}

} // namespace

Domains::Domains(Strips strips) : strips_(std::move(strips)) {
    const Strips whole({}, other_axis(strips_.axis()));
    groups_.assign(static_cast<std::size_t>(strips_.size()), whole);
    for (int strip = 0; strip <= strips_.size(); ++strip) first_ranks_.push_back(strip);
}

Domains::Domains(Strips strips, std::vector<Strips> groups)
    : strips_(std::move(strips)), groups_(std::move(groups)), first_ranks_{0} {
    ensure(groups_.size() == static_cast<std::size_t>(strips_.size()),
           "each strip needs one group of ranks");
    for (const Strips& group : groups_) first_ranks_.push_back(first_ranks_.back() + group.size());
}

int Domains::largest_group() const {
    int most = 0;
    for (const Strips& group : groups_) most = std::max(most, group.size());
    return most;
}

int Domains::strip_of(int rank) const {
    if (!are_cut_across()) return rank;
    const auto behind = std::upper_bound(first_ranks_.begin(), first_ranks_.end(), rank);
    return static_cast<int>(behind - first_ranks_.begin()) - 1;
}

Domain Domains::of(int rank) const {
    const int strip = strip_of(rank);
    return {strips_.of(strip), group(strip).of(rank - first_rank(strip))};
}

std::vector<int> Domains::neighbours_within(int rank, double reach) const {
    const int own_strip = strip_of(rank);
    std::vector<int> strips = strips_.neighbours_within(own_strip, reach);
    if (!are_cut_across()) return strips;
    const Domain mine = of(rank);
    if (mine.is_empty()) return {};
    strips.insert(std::upper_bound(strips.begin(), strips.end(), own_strip), own_strip);
    std::vector<int> neighbours;
    for (const int strip : strips) {
        for (int other = first_rank(strip); other < first_rank(strip + 1); ++other) {
            const Strip across = group(strip).of(other - first_rank(strip));
            if (other != rank && !across.is_empty() && are_within(mine.across, across, reach))
                neighbours.push_back(other);
        }
    }
    return neighbours;
}

Domains Domains::stretched(double along_x, double along_y) const {
    const auto factor = [&](Axis of) { return of == Axis::x ? along_x : along_y; };
    std::vector<Strips> groups;
    for (const Strips& group : groups_)
        groups.push_back(group.stretched(factor(other_axis(axis()))));
    return {strips_.stretched(factor(axis())), std::move(groups)};
}

std::vector<int> movers_between(const Domains& before, const Domains& after, int rank,
                                double distance) {
    ensure(before.size() == after.size(), "domains before and after are of different numbers");
    const auto can_go = [distance](const Domain& from, const Domain& to) {
        return !from.is_empty() && !to.is_empty() && can_move(from.along, to.along, distance) &&
               can_move(from.across, to.across, distance);
    };
    const Domain from = before.of(rank), to = after.of(rank);
    std::vector<int> partners;
    for (int other = 0; other < before.size(); ++other) {
        if (other == rank) continue;
        if (can_go(from, after.of(other)) || can_go(before.of(other), to))
            partners.push_back(other);
    }
    return partners;
}

std::vector<int> choose_groups(const GroupNeeds& needs) {
    const double of_strips = share_seen(needs, needs.n_ranks);
    int best = needs.n_ranks;
    double least = of_strips;
    for (int n_strips = 1; n_strips < needs.n_ranks; ++n_strips) {
        const double seen = share_seen(needs, n_strips);
        if (seen >= least) continue;
        least = seen;
        best = n_strips;
    }
    const double saved = (of_strips - least) * needs.n_discs / needs.n_ranks;
    const bool are_worth_it = least < worth_a_group * of_strips && saved >= least_saved;
    return even_groups(needs.n_ranks, are_worth_it ? best : needs.n_ranks);
}

std::vector<int> groups_of(int n_ranks, int n_across) {
    return even_groups(n_ranks, (n_ranks + n_across - 1) / n_across);
}

std::vector<double> shares_below_cuts(const std::vector<int>& group_sizes) {
    double n_ranks = 0;
    for (const int size : group_sizes) n_ranks += size;
    std::vector<double> below;
    double n_below = 0;
    for (std::size_t k = 0; k + 1 < group_sizes.size(); ++k) {
        n_below += group_sizes[k];
        below.push_back(n_below / n_ranks);
    }
    return below;
}

} // namespace carrom
