// SPDX-License-Identifier: BSD-3-Clause
// Plans for periodic boundaries, where strips are neighbours across the sides of the
// box too, and a rank is its own neighbour.
#include <algorithm>
#include <cmath>

#include "core/errors.hpp"
#include "domain/transfer_in_parts.hpp"

namespace carrom {

namespace {

/// Lists of partners reach this much further than the distances, because images are rounded.
constexpr double margin = 1e-9;

/// A strip that ends where the box does.
struct Slab {
    double low = 0, high = 0;

    Slab(const Strips& strips, int rank, double period)
        : low(strips.low(rank)), high(strips.high(rank)) {
        if (period == 0) return;
        if (rank == 0) low = 0;
        if (rank + 1 == strips.size()) high = period;
    }
    /// Whether something in the slab can be within `distance` of something in the other one, or of
    /// its images.
    bool is_near(const Slab& other, double distance, double period) const {
        const double n_last = period == 0 ? 0 : std::ceil(distance / period) + 1;
        for (double n = -n_last; n <= n_last; ++n)
            if (low - distance <= other.high + n * period &&
                high + distance >= other.low + n * period)
                return true;
        return false;
    }
};

/// Always asks in the same order, so that two ranks that ask for each other get the same answer.
bool are_near(const Strips& a, int rank_a, const Strips& b, int rank_b, double distance,
              double period) {
    if (a.is_empty(rank_a) || b.is_empty(rank_b)) return false;
    return Slab(a, rank_a, period).is_near(Slab(b, rank_b, period), distance, period);
}

/// The displacements by n periods that may bring `place` to within `reach` of low ..
/// high. There may be a few too many.
struct Shifts {
    int first = 0, last = 0;

    Shifts(double place, double reach, double low, double high, double period) {
        if (period == 0) return;
        if (place - low < (1 - margin) * period - reach &&
            high - place < (1 - margin) * period - reach)
            return; // nearly always so along one axis
        const double lowest = low - reach - margin * period,
                     highest = high + reach + margin * period;
        while (place + first * period < lowest) ++first;
        while (place + (first - 1) * period >= lowest) --first;
        for (last = first; place + (last + 1) * period <= highest;) ++last;
    }
};

DiscState as_image(DiscState disc, Image image) {
    set_image(disc, image);
    return disc;
}

std::vector<std::size_t> places_of(const std::vector<int>& partners, int n_ranks) {
    std::vector<std::size_t> places(static_cast<std::size_t>(n_ranks), partners.size());
    for (std::size_t k = 0; k < partners.size(); ++k)
        places[static_cast<std::size_t>(partners[k])] = k;
    return places;
}

} // namespace

TransferPlan plan_periodic_migration(const Strips& old_strips, const Strips& strips, int rank,
                                     std::span<const DiscState> own, double time, double farthest,
                                     const Periods& periods, int n_threads) {
    TransferPlan plan;
    const Axis axis = strips.axis();
    const double period = periods.along(axis);
    double distance = farthest;
    if (period != 0)
        distance = std::min(farthest, period) +
                   margin * period; // no place is further than once around
    for (int other = 0; other < strips.size(); ++other) {
        if (other != rank && (are_near(old_strips, rank, strips, other, distance, period) ||
                              are_near(old_strips, other, strips, rank, distance, period)))
            plan.partners.push_back(other);
    }
    plan.leaving.resize(plan.partners.size());
    const std::vector<std::size_t> places = places_of(plan.partners, strips.size());
    if (strips.size() == 1) return plan;
    const double low = strips.low(rank), high = strips.high(rank);
    const PlaceRange all[] = {{0, own.size()}};
    plan_in_parts(plan, all, n_threads, [&](LocalIndex i, LeavingDiscs& part) {
        const double x = periods.place_of(own[i], axis, time);
        if (x >= low && x < high) return;
        const int owner = strips.owner(x);
        if (owner == rank) return;
        const std::size_t place = places[static_cast<std::size_t>(owner)];
        ensure(place < plan.partners.size(), "a disc goes to a rank that does not expect it");
        part.leaving[place].push_back(i);
    });
    return plan;
}

Inside interior(const Strips& strips, int rank, double reach, const Periods& periods) {
    const Slab mine(strips, rank, periods.along(strips.axis()));
    Inside inner = periods.inside();
    auto& [x_low, x_high, y_low, y_high] = inner;
    (strips.axis() == Axis::x ? x_low : y_low) = mine.low;
    (strips.axis() == Axis::x ? x_high : y_high) = mine.high;
    return {x_low + reach, x_high - reach, y_low + reach, y_high - reach};
}

TransferPlan plan_periodic_halo(const Strips& strips, int rank, std::span<const DiscState> own,
                                std::span<const PlaceRange> ranges, double time, double reach,
                                const Periods& periods, int n_threads) {
    TransferPlan plan;
    const Axis axis = strips.axis();
    const double longest = std::max(periods.x, periods.y), period = periods.along(axis);
    for (int other = 0; other < strips.size(); ++other) {
        if (are_near(strips, std::min(rank, other), strips, std::max(rank, other),
                     reach + margin * longest, period))
            plan.partners.push_back(other);
    }
    plan.leaving.resize(plan.partners.size());
    plan.images.resize(plan.partners.size());
    std::vector<Slab> slabs;
    for (const int other : plan.partners) slabs.emplace_back(strips, other, period);
    const double period_across = periods.along(other_axis(axis));
    // Moving rows of boxes slide along x, so strips are cut along y then.
    ensure(axis == Axis::y || !periods.are_moving(), "strips are cut along the rows of boxes");
    const double slide = axis == Axis::y ? periods.offset_at(time) : 0;
    const Inside box = periods.inside();
    const double across_low = axis == Axis::x ? box.y_low : box.x_low;
    const double across_high = axis == Axis::x ? box.y_high : box.x_high;
    plan_in_parts(plan, ranges, n_threads, [&](LocalIndex i, LeavingDiscs& part) {
        const auto [u, v] = turned(axis, periods.x_of(own[i], time), periods.y_of(own[i], time));
        const Image home = image_of(own[i]);
        const Shifts at_rest(v, reach, across_low, across_high, period_across);
        for (std::size_t k = 0; k < slabs.size(); ++k) {
            const Shifts along(u, reach, slabs[k].low, slabs[k].high, period);
            for (int n = along.first; n <= along.last; ++n) {
                const double image_u = u + n * period;
                if (image_u + reach < slabs[k].low || image_u - reach > slabs[k].high) continue;
                const double beside = v + n * slide;
                Shifts across = at_rest;
                if (n != 0 && slide != 0) [[unlikely]]
                    across = Shifts(beside, reach, across_low, across_high, period_across);
                for (int m = across.first; m <= across.last; ++m) {
                    const double image_v = beside + m * period_across;
                    if (image_v + reach < across_low || image_v - reach > across_high) continue;
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

void append_images(const TransferPlan& plan, std::vector<DiscState>& values, int n_threads) {
    for (std::size_t k = 0; k < plan.partners.size(); ++k) {
        const std::size_t first = values.size(), n = plan.leaving[k].size();
        values.resize(first + n);
#pragma omp parallel for num_threads(n_threads) schedule(static) if (n >= least_for_threads)
        for (std::size_t i = 0; i < n; ++i)
            values[first + i] = as_image(values[plan.leaving[k][i]], plan.images[k][i]);
    }
}

std::vector<std::size_t> transfer_images(NeighbourExchange& exchange, const TransferPlan& plan,
                                         const std::vector<DiscState>& values,
                                         std::vector<DiscState>& arrived, int n_threads) {
    return transfer_packed(exchange, plan, values, arrived, n_threads,
                           [&plan](const DiscState& disc, std::size_t k, std::size_t i) {
                               return as_image(disc, plan.images[k][i]);
                           });
}

} // namespace carrom
