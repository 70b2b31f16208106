// SPDX-License-Identifier: BSD-3-Clause
// Plans of halos compared with a test of every image of every disc, for domains in groups, in boxes
// with walls, with periodic sides, and with rows that slide. A halo that grows must get the same
// discs as a deeper one, each once.
#include "domain/transfer.hpp"

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include "catch.hpp"

#include "domain/domain_cuts.hpp"

using namespace carrom;

namespace {

constexpr double time = 0.5;
const Box box{12, 9};

std::vector<DiscState> random_discs(std::mt19937& random, std::size_t n) {
    std::uniform_real_distribution<double> x(0, box.x), y(0, box.y);
    std::vector<DiscState> discs(n);
    for (std::size_t i = 0; i < n; ++i) {
        discs[i].id = i;
        discs[i].x = x(random);
        discs[i].y = y(random);
        discs[i].tau = time;
    }
    return discs;
}

/// Receiver, disc, and the image that is sent.
using Sent = std::multiset<std::tuple<int, DiscId, int, int>>;

Sent sent_by(const TransferPlan& plan, const std::vector<DiscState>& own) {
    Sent sent;
    for (std::size_t k = 0; k < plan.partners.size(); ++k)
        for (std::size_t i = 0; i < plan.leaving[k].size(); ++i) {
            const Image image = plan.images.empty() ? Image{} : plan.images[k][i];
            sent.insert({plan.partners[k], own[plan.leaving[k][i]].id, image.x, image.y});
        }
    return sent;
}

Sent planned(const Domains& domains, int rank, const std::vector<DiscState>& own,
             const HaloDepth& depth, const Periods& periods) {
    const PlaceRange all{0, own.size()};
    return sent_by(periods.are_any()
                       ? plan_periodic_halo(domains, rank, own, {&all, 1}, time, depth, periods, 1)
                       : plan_halo(domains, rank, own, {&all, 1}, time, depth, 1),
                   own);
}

/// Whether a position is within `reach` of a domain, which ends at the sides of a periodic box.
bool is_near(const Domain& domain, const Periods& periods, Axis axis, double x, double y,
             double reach) {
    const auto [along, across] = turned(axis, x, y);
    const auto near = [reach](const Strip& strip, double period, double place) {
        const double low = period == 0 ? strip.low : std::max(strip.low, 0.0),
                     high = period == 0 ? strip.high : std::min(strip.high, period);
        return place > low - reach && place < high + reach;
    };
    return near(domain.along, periods.along(axis), along) &&
           near(domain.across, periods.along(other_axis(axis)), across);
}

Sent by_search(const Domains& domains, int rank, const std::vector<DiscState>& own, double reach,
               const Periods& periods) {
    Sent sent;
    const int n_x = periods.x == 0 ? 0 : 4, n_y = periods.y == 0 ? 0 : 4;
    for (const DiscState& disc : own)
        for (int other = 0; other < domains.size(); ++other)
            for (int i = -n_x; i <= n_x; ++i)
                for (int j = -n_y; j <= n_y; ++j) {
                    const Shift shift = periods.shift_of({i, j}, time);
                    if (other == rank && i == 0 && j == 0) continue;
                    if (is_near(domains.of(other), periods, domains.axis(), disc.x + shift.x,
                                disc.y + shift.y, reach))
                        sent.insert({other, disc.id, i, j});
                }
    return sent;
}

std::vector<DiscState> own_of(const Domains& domains, int rank,
                              const std::vector<DiscState>& discs) {
    std::vector<DiscState> own;
    for (const DiscState& disc : discs) {
        const auto [along, across] = turned(domains.axis(), disc.x, disc.y);
        if (domains.owner(along, across) == rank) own.push_back(disc);
    }
    return own;
}

} // namespace

TEST_CASE("halos: plans find every image within reach, and a halo that grows gets the rest") {
    std::mt19937 random(11);
    const Periods all_periods[] = {
        {}, {box.x, 0}, {0, box.y}, {box.x, box.y}, {box.x, box.y, 3.3, 0.25}};
    for (const Periods& periods : all_periods) {
        for (const std::vector<int>& sizes :
             {std::vector<int>{1, 1, 1}, {2, 1, 3}, {4}, {2, 2}, {1}}) {
            const Axis axis = periods.are_moving() ? Axis::y : Axis::x;
            const Domains domains = equal_domains(box, axis, sizes);
            const std::vector<DiscState> discs = random_discs(random, 40);
            for (const double reach : {0.8, 2.5, 7.0}) {
                for (int rank = 0; rank < domains.size(); ++rank) {
                    const std::vector<DiscState> own = own_of(domains, rank, discs);
                    const Sent at_once = planned(domains, rank, own, {reach}, periods);
                    REQUIRE(at_once == by_search(domains, rank, own, reach, periods));
                    const double beyond = 0.4 * reach;
                    Sent in_parts = planned(domains, rank, own, {beyond}, periods);
                    const Sent later = planned(domains, rank, own, {reach, beyond}, periods);
                    in_parts.insert(later.begin(), later.end());
                    REQUIRE(in_parts == at_once);
                }
            }
        }
    }
}

TEST_CASE("halos: partners of a plan are symmetric") {
    const Periods periods{box.x, box.y, 3.3, 0.25};
    const Domains domains = equal_domains(box, Axis::y, {2, 3, 1, 2});
    for (const double reach : {0.1, 1.0, 4.0}) {
        std::vector<std::vector<int>> lists;
        for (int rank = 0; rank < domains.size(); ++rank)
            lists.push_back(halo_partners(domains, rank, reach, periods));
        for (int a = 0; a < domains.size(); ++a)
            for (const int b : lists[static_cast<std::size_t>(a)])
                CHECK(std::ranges::count(lists[static_cast<std::size_t>(b)], a) == 1);
    }
}
