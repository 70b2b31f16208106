// SPDX-License-Identifier: BSD-3-Clause
// Plans transfers in boxes with periodic sides. In such boxes, domains are also neighbours across
// the sides of the box, and a rank may be its own neighbour.
#include <algorithm>
#include <cmath>

#include "core/errors.hpp"
#include "domain/transfer_in_parts.hpp"

namespace carrom {

namespace {

/// When partners and images are chosen, distances are enlarged by this fraction of a period,
/// because positions of images are rounded.
constexpr double margin = 1e-9;

/// The rank's domain, cut off at the sides of the box along periodic axes.
Domain domain_in_box(const Domains& domains, int rank, const Periods& periods) {
    const auto cut = [](Strip& strip, double period) {
        if (period == 0) return;
        if (std::isinf(strip.low)) strip.low = 0;
        if (std::isinf(strip.high)) strip.high = period;
    };
    Domain domain = domains.of(rank);
    cut(domain.along, periods.along(domains.axis()));
    cut(domain.across, periods.along(other_axis(domains.axis())));
    return domain;
}

/// Whether a position in strip `a` can be within `distance` of a position in strip `b`, if strip
/// `b` is displaced by `shift`.
bool are_near(const Strip& a, const Strip& b, double distance, double shift) {
    return a.low - distance <= b.high + shift && a.high + distance >= b.low + shift;
}

/// Whether a position in strip `a` can be within `distance` of a position in strip `b` or of its
/// images. If `is_beyond`, strip `b` itself does not count, but only its images.
bool are_near_images(const Strip& a, const Strip& b, double distance, double period,
                     bool is_beyond) {
    const double n_last = period == 0 ? 0 : std::ceil(distance / period) + 1;
    for (double n = -n_last; n <= n_last; ++n)
        if ((n != 0 || !is_beyond) && are_near(a, b, distance, n * period)) return true;
    return false;
}

/// Whether a position in the domain of `rank_a` can be within the distances, along and across, of a
/// position in the domain of `rank_b` or of its images. Both ranks get the same result, because the
/// order of the tests is the same on both.
bool are_near(const Domains& a, int rank_a, const Domains& b, int rank_b, double distance,
              double distance_across, const Periods& periods) {
    if (a.is_empty(rank_a) || b.is_empty(rank_b)) return false;
    const double period = periods.along(a.axis()),
                 period_across = periods.along(other_axis(a.axis()));
    const Domain from = domain_in_box(a, rank_a, periods), to = domain_in_box(b, rank_b, periods);
    // If rows of boxes slide, any position along x may come to lie above any other.
    if (periods.are_moving() && are_near_images(from.along, to.along, distance, period, true))
        return true;
    return are_near_images(from.along, to.along, distance, period, false) &&
           are_near_images(from.across, to.across, distance_across, period_across, false);
}

/// The range of n for which a displacement by n periods may bring `place` to within `reach` of the
/// interval [low, high]. The range may be slightly too large.
struct Shifts {
    int first = 0, last = 0;

    Shifts(double place, double reach, double low, double high, double period) {
        if (period == 0) return;
        if (place - low < (1 - margin) * period - reach &&
            high - place < (1 - margin) * period - reach)
            return; // the case of nearly all discs, along at least one axis
        const double lowest = low - reach - margin * period,
                     highest = high + reach + margin * period;
        while (place + first * period < lowest) ++first;
        while (place + (first - 1) * period >= lowest) --first;
        for (last = first; place + (last + 1) * period <= highest;) ++last;
    }
};

DiscState as_image(const DiscState& disc, Image image) {
    DiscState shifted = disc;
    set_image(shifted, image);
    return shifted;
}

std::vector<std::size_t> places_of(const std::vector<int>& partners, int n_ranks) {
    std::vector<std::size_t> places(static_cast<std::size_t>(n_ranks), partners.size());
    for (std::size_t k = 0; k < partners.size(); ++k)
        places[static_cast<std::size_t>(partners[k])] = k;
    return places;
}

} // namespace

TransferPlan plan_periodic_migration(const Domains& before, const Domains& domains, int rank,
                                     std::span<const DiscState> own, double time, double farthest,
                                     const Periods& periods, int n_threads) {
    TransferPlan plan;
    const Axis axis = domains.axis();
    const auto distance_along = [&](Axis of) { // along a periodic axis at most 1 + margin periods
        const double period = periods.along(of);
        return period == 0 ? farthest : std::min(farthest, period) + margin * period;
    };
    const double distance = distance_along(axis),
                 distance_across = distance_along(other_axis(axis));
    for (int other = 0; other < domains.size(); ++other) {
        if (other != rank &&
            (are_near(before, rank, domains, other, distance, distance_across, periods) ||
             are_near(before, other, domains, rank, distance, distance_across, periods)))
            plan.partners.push_back(other);
    }
    plan.leaving.resize(plan.partners.size());
    const std::vector<std::size_t> places = places_of(plan.partners, domains.size());
    if (domains.size() == 1) return plan;
    const Domain mine = domains.of(rank);
    const PlaceRange all[] = {{0, own.size()}};
    plan_in_parts(plan, all, n_threads, [&](LocalIndex i, LeavingDiscs& part) {
        const double along = periods.place_of(own[i], axis, time);
        const double across = domains.are_cut_across()
                                  ? periods.place_of(own[i], other_axis(axis), time)
                                  : 0; // any value: strips are not cut across, so it is not used
        if (mine.holds(along, across)) return;
        const int owner = domains.owner(along, across);
        if (owner == rank) return;
        const std::size_t place = places[static_cast<std::size_t>(owner)];
        ensure(place < plan.partners.size(), "a disc goes to a rank that does not expect it");
        part.leaving[place].push_back(i);
    });
    return plan;
}

Inside interior(const Domains& domains, int rank, double reach, const Periods& periods) {
    const Domain mine = domain_in_box(domains, rank, periods);
    const auto [x, y] = turned(domains.axis(), mine.along, mine.across);
    return {x.low + reach, x.high - reach, y.low + reach, y.high - reach};
}

std::vector<int> halo_partners(const Domains& domains, int rank, double reach,
                               const Periods& periods) {
    if (!periods.are_any()) return domains.neighbours_within(rank, reach);
    const double distance = reach + margin * std::max(periods.x, periods.y);
    std::vector<int> partners;
    for (int other = 0; other < domains.size(); ++other) {
        if (are_near(domains, std::min(rank, other), domains, std::max(rank, other), distance,
                     distance, periods))
            partners.push_back(other);
    }
    return partners;
}

TransferPlan plan_periodic_halo(const Domains& domains, int rank, std::span<const DiscState> own,
                                std::span<const PlaceRange> ranges, double time,
                                const HaloDepth& depth, const Periods& periods, int n_threads) {
    TransferPlan plan;
    const Axis axis = domains.axis();
    const double period = periods.along(axis), period_across = periods.along(other_axis(axis)),
                 reach = depth.reach;
    plan.partners = halo_partners(domains, rank, reach, periods);
    plan.leaving.resize(plan.partners.size());
    plan.images.resize(plan.partners.size());
    std::vector<Domain> theirs;
    for (const int other : plan.partners) theirs.push_back(domain_in_box(domains, other, periods));
    // Moving rows of boxes slide along x, so strips must follow each other along y.
    ensure(axis == Axis::y || !periods.are_moving(), "strips are cut along the rows of boxes");
    const double slide = axis == Axis::y ? periods.offset_at(time) : 0;
    const auto is_far = [](const Strip& strip, double place, double distance) {
        return place + distance < strip.low || place - distance > strip.high;
    };
    plan_in_parts(plan, ranges, n_threads, [&](LocalIndex i, LeavingDiscs& part) {
        const auto [u, v] = turned(axis, periods.x_of(own[i], time), periods.y_of(own[i], time));
        const Image home = image_of(own[i]);
        for (std::size_t k = 0; k < theirs.size(); ++k) {
            const Strip &strip = theirs[k].along, &strip_across = theirs[k].across;
            const Shifts along(u, reach, strip.low, strip.high, period);
            for (int n = along.first; n <= along.last; ++n) {
                const double image_u = u + n * period;
                if (is_far(strip, image_u, reach)) continue;
                const bool is_deep = depth.beyond < 0 || is_far(strip, image_u, depth.beyond);
                const double beside = v + n * slide;
                const Shifts across(beside, reach, strip_across.low, strip_across.high,
                                    period_across);
                for (int m = across.first; m <= across.last; ++m) {
                    const double image_v = beside + m * period_across;
                    if (is_far(strip_across, image_v, reach)) continue;
                    if (!is_deep && !is_far(strip_across, image_v, depth.beyond)) continue;
                    if (plan.partners[k] == rank && n == 0 && m == 0) continue;
                    const auto [by_x, by_y] = turned(axis, n, m);
                    part.leaving[k].push_back(i);
                    part.images[k].push_back({home.x + by_x, home.y + by_y});
                }
            }
        }
    });
    return plan;
}

void append_images(const TransferPlan& plan, DiscStates& values, int n_threads) {
    for (std::size_t k = 0; k < plan.partners.size(); ++k) {
        const std::size_t first = values.size(), n = plan.leaving[k].size();
        values.resize(first + n);
#pragma omp parallel for num_threads(n_threads) schedule(static) if (n >= least_for_threads)
        for (std::size_t i = 0; i < n; ++i)
            values[first + i] = as_image(values[plan.leaving[k][i]], plan.images[k][i]);
    }
}

std::vector<std::size_t> transfer_images(NeighbourExchange& exchange, const TransferPlan& plan,
                                         const DiscStates& values, DiscStates& arrived,
                                         int n_threads) {
    return transfer_packed(exchange, plan, values, arrived, n_threads,
                           [&plan](const DiscState& disc, std::size_t k, std::size_t i) {
                               return as_image(disc, plan.images[k][i]);
                           });
}

} // namespace carrom
