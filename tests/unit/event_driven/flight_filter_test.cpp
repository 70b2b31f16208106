// SPDX-License-Identifier: BSD-3-Clause
// The filter of flights compared with all pairs in double precision: it finds every pair that
// touches, once, and none that stays clearly apart.
#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "event_driven/flight_filter.hpp"

using namespace carrom;

namespace {

constexpr double diameter = 0.4; // diameter in cells
constexpr double margin = 1e-3;  // the filter's diameter is larger by this share
constexpr int n_columns = 7, n_rows = 9;
const auto touching_squared = static_cast<float>((diameter + margin) * (diameter + margin));

/// Discs sorted into cells, by column and row, some of them at rest.
struct Flights {
    explicit Flights(unsigned seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> place(0, 1), speed(-0.7f, 0.7f);
        for (int column = 0; column < n_columns; ++column) {
            for (int row = 0; row < n_rows; ++row) {
                starts.push_back(size());
                for (auto n_here = random() % 9; n_here > 0; --n_here) {
                    x.push_back(static_cast<float>(column) + place(random));
                    y.push_back(static_cast<float>(row) + place(random));
                    const bool is_at_rest = random() % 5 == 0;
                    vx.push_back(is_at_rest ? 0 : speed(random));
                    vy.push_back(is_at_rest ? 0 : speed(random));
                }
            }
            starts.push_back(size());
        }
        n = size();
        for (std::vector<float>* lane : {&x, &y, &vx, &vy}) lane->resize(n + filter_padding);
    }

    std::uint32_t size() const { return static_cast<std::uint32_t>(x.size()); }
    FlightLanes lanes() const { return {x.data(), y.data(), vx.data(), vy.data()}; }
    CellTable table() const { return {starts.data(), n_rows + 1, n_columns, n_rows, 2, 2}; }
    SlotRange cells(int column, int first_row, int end_row) const {
        const auto at = static_cast<std::size_t>(column * (n_rows + 1));
        return {starts[at + static_cast<std::size_t>(first_row)],
                starts[at + static_cast<std::size_t>(end_row)]};
    }
    Flight flight(std::uint32_t slot, float now) const {
        return {x[slot] + vx[slot] * now, y[slot] + vy[slot] * now, vx[slot], vy[slot], now, slot};
    }

    /// The smallest distance of two discs from `now` to the window's end.
    double least_distance(std::uint32_t p, std::uint32_t q, double now) const {
        const double wx = double{vx[q]} - vx[p], wy = double{vy[q]} - vy[p];
        const double dx = double{x[q]} - x[p], dy = double{y[q]} - y[p];
        const double w_squared = wx * wx + wy * wy;
        const double nearest = w_squared > 0 ? -(dx * wx + dy * wy) / w_squared : now;
        const double time = std::clamp(nearest, now, 1.0);
        return std::hypot(dx + wx * time, dy + wy * time);
    }

    /// Whether `found` contains the discs of `range` that will touch `p`, except `left_out`.
    bool are_partners(std::vector<std::uint32_t> found, SlotRange range, std::uint32_t p,
                      std::vector<std::uint32_t> left_out, double now) const {
        for (std::uint32_t slot = range.begin; slot < range.end; ++slot) {
            const bool is_out = std::count(left_out.begin(), left_out.end(), slot) > 0;
            const double distance = least_distance(p, slot, now);
            const auto n_found = std::count(found.begin(), found.end(), slot);
            if (n_found > (is_out || distance > diameter + 2 * margin ? 0 : 1)) return false;
            if (!is_out && distance < diameter && n_found == 0) return false;
        }
        return true;
    }

    std::uint32_t n = 0;
    std::vector<float> x, y, vx, vy;
    std::vector<std::uint32_t> starts;
};

std::vector<std::uint32_t> first_of(const std::vector<std::uint32_t>& list, std::size_t n) {
    return {list.begin(), list.begin() + static_cast<std::ptrdiff_t>(n)};
}

} // namespace

TEST_CASE("flights: all that touch are found among some runs of slots") {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const Flights flights(seed);
        std::mt19937 random(seed);
        std::vector<std::uint32_t> p_out(flights.n + filter_padding), q_out(p_out.size());
        for (int k = 0; k < 40; ++k) {
            const auto p = static_cast<std::uint32_t>(random() % flights.n),
                       q = static_cast<std::uint32_t>(random() % flights.n);
            const float now = static_cast<float>(random() % 100) / 100;
            const int column = static_cast<int>(random() % (n_columns - 1));
            const std::vector<SlotRange> runs = {flights.cells(column, 1, n_rows - 1),
                                                 flights.cells(column + 1, 0, n_rows - 2)};
            const std::size_t n = flight_filters<FlightLanes>().one(
                flights.lanes(), runs, flights.flight(p, now), touching_squared, p_out.data());
            for (const SlotRange& run : runs)
                REQUIRE(flights.are_partners(first_of(p_out, n), run, p, {p}, now));
            if (p == q) continue;
            const PartnerCounts both = flight_filters<FlightLanes>().two(
                flights.lanes(), runs, flights.flight(p, now), flights.flight(q, now),
                touching_squared, touching_squared, p_out.data(), q_out.data());
            for (const SlotRange& run : runs) {
                REQUIRE(flights.are_partners(first_of(p_out, both.p), run, p, {p, q}, now));
                REQUIRE(flights.are_partners(first_of(q_out, both.q), run, q, {p, q}, now));
            }
        }
    }
}

TEST_CASE("flights: discs of several sizes are found as near as the sum of their radii") {
    const Flights flights(31);
    std::mt19937 random(32);
    std::vector<float> radii(flights.n + filter_padding);
    for (float& radius : radii) radius = 0.05f * static_cast<float>(1 + random() % 9);
    SizedLanes lanes;
    static_cast<FlightLanes&>(lanes) = flights.lanes();
    lanes.radii = radii.data();
    std::vector<std::uint32_t> p_out(flights.n + filter_padding), q_out(p_out.size());
    const std::vector<SlotRange> runs = {{0, flights.n}};
    std::size_t n_touching = 0;
    const auto check = [&](std::span<const std::uint32_t> found, std::uint32_t p,
                           std::uint32_t other, double now) {
        for (std::uint32_t slot = 0; slot < flights.n; ++slot) {
            const auto n = std::ranges::count(found, slot);
            const double distance = flights.least_distance(p, slot, now),
                         sum = double{radii[p]} + double{radii[slot]};
            const bool is_out = slot == p || slot == other;
            REQUIRE(n <= (is_out || distance > sum + 2 * margin ? 0 : 1));
            REQUIRE((is_out || distance > sum || n == 1));
            n_touching += n > 0;
        }
    };
    for (int k = 0; k < 60; ++k) {
        const auto p = static_cast<std::uint32_t>(random() % flights.n),
                   q = static_cast<std::uint32_t>(random() % flights.n);
        const float now = static_cast<float>(random() % 100) / 100;
        const auto wide = [&](std::uint32_t slot) {
            return radii[slot] + static_cast<float>(margin);
        };
        const std::size_t n = flight_filters<SizedLanes>().one(lanes, runs, flights.flight(p, now),
                                                               wide(p), p_out.data());
        check({p_out.data(), n}, p, p, now);
        if (p == q) continue;
        const PartnerCounts both = flight_filters<SizedLanes>().two(
            lanes, runs, flights.flight(p, now), flights.flight(q, now), wide(p), wide(q),
            p_out.data(), q_out.data());
        check({p_out.data(), both.p}, p, q, now);
        check({q_out.data(), both.q}, q, p, now);
    }
    CHECK(n_touching > 200);
}

TEST_CASE("flights: of a column each pair that touches is found from its first disc") {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const Flights flights(seed);
        for (int column = 0; column < n_columns; ++column) {
            std::vector<std::uint32_t> later, ends;
            flight_filters<FlightLanes>().column(flights.lanes(), flights.table(), column,
                                                 {0, n_rows}, touching_squared, later, ends);
            const SlotRange own = flights.cells(column, 0, n_rows);
            REQUIRE(ends.size() == own.end - own.begin);
            const int last = std::min(column + 2, n_columns - 1);
            std::uint32_t begin = 0;
            for (std::uint32_t slot = own.begin; slot < own.end; ++slot) {
                const std::uint32_t end = ends[slot - own.begin];
                const SlotRange after{slot + 1, flights.cells(last, 0, n_rows).end};
                REQUIRE(flights.are_partners({later.begin() + begin, later.begin() + end}, after,
                                             slot, {}, 0));
                begin = end;
            }
        }
    }
}
