// SPDX-License-Identifier: BSD-3-Clause
// Plans of transfers compared with their definition, for any number of threads.
#include "domain/transfer.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include "catch.hpp"

using namespace carrom;

namespace {

constexpr double length = 100;
const Strips strips({20, 45, 46, 80});
const Domains domains(strips);

std::vector<DiscState> discs_between(double low, double high, std::size_t n) {
    std::mt19937 random(21);
    std::uniform_real_distribution<double> along(low, high), across(0, length), speed(-1, 1);
    std::vector<DiscState> discs(n);
    for (std::size_t i = 0; i < n; ++i) {
        discs[i].id = i;
        discs[i].x = along(random);
        discs[i].y = across(random);
        discs[i].vx = speed(random);
        discs[i].vy = speed(random);
    }
    return discs;
}

/// Ranges of all lengths, with gaps, so that shares of threads begin and end inside ranges.
std::vector<PlaceRange> ranges_of(std::size_t n) {
    std::vector<PlaceRange> ranges;
    std::size_t length_of_range = 1;
    for (std::size_t begin = 3; begin < n; begin += length_of_range + 2, length_of_range *= 3)
        ranges.push_back({begin, std::min(begin + length_of_range, n)});
    return ranges;
}

bool is_same(const TransferPlan& a, const TransferPlan& b) {
    bool are_same = a.partners == b.partners && a.leaving == b.leaving &&
                    a.images.size() == b.images.size();
    for (std::size_t k = 0; k < a.images.size() && are_same; ++k) {
        are_same = a.images[k].size() == b.images[k].size();
        for (std::size_t i = 0; i < a.images[k].size() && are_same; ++i)
            are_same = a.images[k][i].x == b.images[k][i].x && a.images[k][i].y == b.images[k][i].y;
    }
    return are_same;
}

} // namespace

TEST_CASE("plans: a halo has the discs within reach of the other strip, whoever searches") {
    const double time = 2, reach = 7;
    for (const std::size_t n : {10u, 30000u}) {
        const std::vector<DiscState> discs = discs_between(20, 45, n);
        const std::vector<PlaceRange> searched = ranges_of(n);
        for (const int n_threads : {1, 2, 5}) {
            const TransferPlan plan = plan_halo(domains, 1, discs, searched, time, {reach},
                                                n_threads);
            CHECK(plan.partners == strips.neighbours_within(1, reach));
            bool is_right = true;
            for (std::size_t k = 0; k < plan.partners.size(); ++k) {
                std::vector<LocalIndex> wanted;
                const Strip theirs = strips.of(plan.partners[k]);
                for (const PlaceRange range : searched)
                    for (std::size_t i = range.begin; i < range.end; ++i) {
                        const double x = discs[i].x_at(time);
                        if (x - reach < theirs.high && x + reach >= theirs.low)
                            wanted.push_back(static_cast<LocalIndex>(i));
                    }
                is_right = is_right && plan.leaving[k] == wanted;
            }
            CHECK(is_right);
        }
    }
}

TEST_CASE("plans: a migration has the discs whose place is another rank's, whoever searches") {
    const double time = 1.5;
    const std::vector<DiscState> discs = discs_between(19, 48, 30000);
    const PlaceRange all[] = {{0, discs.size()}};
    const TransferPlan plan = plan_migration(domains, domains, 1, discs, all, time, 30, 1);
    bool is_right = true;
    std::size_t n_leaving = 0;
    for (std::size_t k = 0; k < plan.partners.size(); ++k)
        for (const LocalIndex i : plan.leaving[k]) {
            is_right = is_right && strips.owner(discs[i].x_at(time)) == plan.partners[k];
            ++n_leaving;
        }
    for (const DiscState& disc : discs) n_leaving -= strips.owner(disc.x_at(time)) != 1;
    CHECK(is_right);
    CHECK(n_leaving == 0);
    CHECK(is_same(plan, plan_migration(domains, domains, 1, discs, all, time, 30, 3)));
    const Periods periods{length, length};
    const TransferPlan around = plan_periodic_migration(domains, domains, 1, discs, time, 40,
                                                        periods, 1);
    CHECK(
        is_same(around, plan_periodic_migration(domains, domains, 1, discs, time, 40, periods, 4)));
}

TEST_CASE("plans: images of a halo do not depend on the threads") {
    const Periods periods{length, length};
    for (const int rank : {0, 1, 4}) {
        const std::vector<DiscState> discs = discs_between(
            rank == 0 ? 0 : strips.low(rank), rank == 4 ? length : strips.high(rank), 20000);
        const PlaceRange all[] = {{0, discs.size()}};
        const TransferPlan plan = plan_periodic_halo(domains, rank, discs, all, 0, {9}, periods, 1);
        CHECK(is_same(plan, plan_periodic_halo(domains, rank, discs, all, 0, {9}, periods, 3)));
        std::size_t n = 0;
        for (const std::vector<LocalIndex>& leaving : plan.leaving) n += leaving.size();
        CHECK(n > 1000);
    }
}
