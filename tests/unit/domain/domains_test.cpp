// SPDX-License-Identifier: BSD-3-Clause
// Domains compared with brute force at sampled positions, with many equal cuts and with groups of
// any sizes.
#include "domain/domains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "catch.hpp"

#include "domain/domain_cuts.hpp"
#include "strips_support.hpp"

using carrom::Axis;
using carrom::Domain;
using carrom::Domains;
using carrom::Strips;
using namespace carrom::test;

namespace {

std::vector<int> random_sizes(std::mt19937& random, int n_ranks) {
    std::vector<int> sizes;
    while (n_ranks > 0) {
        sizes.push_back(std::min(n_ranks, 1 + static_cast<int>(random() % 4)));
        n_ranks -= sizes.back();
    }
    return sizes;
}

Domains random_domains(std::mt19937& random, const std::vector<int>& sizes) {
    std::vector<Strips> groups;
    for (const int size : sizes) groups.push_back(random_strips(random, size, Axis::y));
    return Domains(random_strips(random, static_cast<int>(sizes.size()), Axis::x), groups);
}

struct Place {
    double along, across;
};

/// Positions at which errors are likely: on the cuts, immediately beside them, and anywhere.
std::vector<Place> probes(std::mt19937& random, const Domains& domains) {
    const auto around = [](std::vector<double>& list, const Strips& strips) {
        for (const double cut : strips.cuts())
            for (const double x : {cut, std::nextafter(cut, -1e9), std::nextafter(cut, 1e9)})
                list.push_back(x);
    };
    std::vector<double> xs = {0, box}, ys = {0, box};
    around(xs, domains.strips());
    for (int strip = 0; strip < domains.n_strips(); ++strip) around(ys, domains.group(strip));
    std::uniform_real_distribution<double> anywhere(-1, box + 1);
    for (int k = 0; k < 10; ++k) xs.push_back(anywhere(random)), ys.push_back(anywhere(random));
    std::vector<Place> places;
    for (int k = 0; k < 60; ++k)
        places.push_back({xs[random() % xs.size()], ys[random() % ys.size()]});
    return places;
}

int owner_by_search(const Domains& domains, Place place) {
    int found = -1;
    for (int rank = 0; rank < domains.size(); ++rank) {
        const Domain domain = domains.of(rank);
        if (domain.along.low <= place.along && place.along < domain.along.high &&
            domain.across.low <= place.across && place.across < domain.across.high)
            found = found == -1 ? rank : -2;
    }
    return found;
}

} // namespace

TEST_CASE("domains: one domain owns everything") {
    const Domains all;
    CHECK(all.size() == 1);
    CHECK(all.owner(-1e300, 1e300) == 0);
    CHECK_FALSE(all.are_cut_across());
    CHECK(all.neighbours_within(0, 1e9).empty());
    CHECK(movers_between(all, all, 0, 1e9).empty());
}

TEST_CASE("domains: ranks of a group follow each other across their strip") {
    // Strip 0 has ranks 0 to 2, strip 1 has rank 3, strip 2 has ranks 4 and 5.
    const Domains domains(Strips({2, 6}, Axis::x),
                          {Strips({1, 8}, Axis::y), Strips({}, Axis::y), Strips({5}, Axis::y)});
    CHECK(domains.size() == 6);
    CHECK(domains.are_cut_across());
    CHECK(domains.owner(1, 0) == 0);
    CHECK(domains.owner(1, 1) == 1);
    CHECK(domains.owner(1, 8) == 2);
    CHECK(domains.owner(2, 8) == 3);
    CHECK(domains.owner(6, 4) == 4);
    CHECK(domains.owner(6, 5) == 5);
    CHECK(domains.strip_of(2) == 0);
    CHECK(domains.strip_of(3) == 1);
    CHECK(domains.strip_of(5) == 2);
    CHECK(domains.neighbours_within(0, 0.5) == std::vector<int>{1, 3});
    CHECK(domains.neighbours_within(3, 0.5) == std::vector<int>{0, 1, 2, 4, 5});
    CHECK(domains.neighbours_within(0, 4) == std::vector<int>{1, 3, 4, 5});
    CHECK(domains.neighbours_within(0, 3.9) == std::vector<int>{1, 3});
    CHECK(domains.neighbours_within(0, 7) == std::vector<int>{1, 2, 3, 4, 5});
}

TEST_CASE("domains: every place has one owner, found by search") {
    std::mt19937 random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const Domains domains = random_domains(random, random_sizes(random, 1 + trial % 12));
        for (const Place place : probes(random, domains)) {
            const int owner = domains.owner(place.along, place.across);
            REQUIRE(owner == owner_by_search(domains, place));
            REQUIRE_FALSE(domains.is_empty(owner));
        }
    }
}

TEST_CASE("domains: neighbours are symmetric, complete for every sender, and no more than needed") {
    std::mt19937 random(3);
    for (int trial = 0; trial < 300; ++trial) {
        const Domains domains = random_domains(random, random_sizes(random, 1 + trial % 12));
        const double reach = trial % 5 == 0 ? 2.0 * (trial % 3)
                                            : std::uniform_real_distribution<double>(0, 4)(random);
        std::vector<std::vector<int>> lists;
        for (int rank = 0; rank < domains.size(); ++rank)
            lists.push_back(domains.neighbours_within(rank, reach));
        check_lists(lists);
        for (const Place place : probes(random, domains)) {
            const int own = owner_by_search(domains, place);
            for (int rank = 0; rank < domains.size(); ++rank)
                if (rank != own && !domains.is_empty(rank) &&
                    domains.of(rank).is_within(reach, place.along, place.across))
                    REQUIRE(contains(lists[static_cast<std::size_t>(own)], rank));
        }
        const auto gap = [](const carrom::Strip& a, const carrom::Strip& b) {
            return std::max(a.low - b.high, b.low - a.high);
        };
        for (int a = 0; a < domains.size(); ++a)
            for (const int b : lists[static_cast<std::size_t>(a)]) {
                const Domain mine = domains.of(a), theirs = domains.of(b);
                REQUIRE_FALSE(theirs.is_empty());
                REQUIRE(gap(mine.along, theirs.along) <= reach * (1 + 1e-12) + 1e-12);
                REQUIRE(gap(mine.across, theirs.across) <= reach * (1 + 1e-12) + 1e-12);
            }
    }
}

TEST_CASE("domains: movers are symmetric and know every way a disc can go") {
    std::mt19937 random(4);
    for (int trial = 0; trial < 300; ++trial) {
        const std::vector<int> sizes = random_sizes(random, 1 + trial % 12);
        const Domains before = random_domains(random, sizes);
        const Domains after = trial % 3 == 0 ? before : random_domains(random, sizes);
        const double distance = trial % 4 == 0
                                    ? 0
                                    : std::uniform_real_distribution<double>(0, 3)(random);
        std::vector<std::vector<int>> lists;
        for (int rank = 0; rank < before.size(); ++rank)
            lists.push_back(movers_between(before, after, rank, distance));
        check_lists(lists);
        std::uniform_real_distribution<double> shift(-distance, distance);
        for (const Place place : probes(random, before)) {
            for (const double by : {0.0, -distance, distance, shift(random)}) {
                const int sender = owner_by_search(before, place),
                          receiver = owner_by_search(
                              after, {place.along + by, place.across + shift(random)});
                if (sender != receiver)
                    REQUIRE(contains(lists[static_cast<std::size_t>(sender)], receiver));
            }
        }
    }
}

TEST_CASE(
    "domains: discs at rest in unchanged domains have nowhere to go but across a shared cut") {
    const Domains strips(Strips({2, 5, 8}));
    CHECK(movers_between(strips, strips, 1, 0) == std::vector<int>{0, 2});
    CHECK(movers_between(strips, Domains(Strips({6, 7, 8})), 0, 0) == std::vector<int>{1, 2});
    CHECK(movers_between(strips, strips, 0, std::numeric_limits<double>::infinity()) ==
          std::vector<int>{1, 2, 3});
}

TEST_CASE("domains: groups make domains about square where strips would be narrow, for any number "
          "of ranks") {
    for (const int n_ranks : {1, 2, 3, 7, 16, 97, 1000, 1024}) {
        for (const double halo : {0.0, 1e-4, 0.01, 0.1}) {
            const std::vector<int> sizes = carrom::choose_groups({n_ranks, 1e7, 3, 1, halo});
            CHECK(std::accumulate(sizes.begin(), sizes.end(), 0) == n_ranks);
            const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
            CHECK(*least >= 1);
            CHECK(*most - *least <= 1);
            if (n_ranks * halo < 0.05) CHECK(*most == 1);
        }
    }
    CHECK(carrom::choose_groups({16, 1e5, 1, 1, 0.05, true, true}) == std::vector<int>{4, 4, 4, 4});
    CHECK(carrom::choose_groups({16, 1e5, 1, 1, 0.05}) == std::vector<int>{4, 4, 4, 4});
    CHECK(carrom::choose_groups({64, 1e5, 4, 1, 0.05, true, true}).size() == 16);
    // Groups would save 0.9 discs for each own one, which is too few of 500.
    CHECK(carrom::choose_groups({16, 8e3, 1, 1, 0.05, true, true}).size() == 16);
    CHECK(carrom::groups_of(7, 3) == std::vector<int>{2, 2, 3});
    CHECK(carrom::groups_of(4, 1) == std::vector<int>{1, 1, 1, 1});
}

TEST_CASE("domains: equal domains have equal areas") {
    const std::vector<int> sizes = {2, 2, 3};
    const Domains domains = carrom::equal_domains({14, 6}, Axis::x, sizes);
    for (int rank = 0; rank < 7; ++rank) {
        const Domain domain = domains.of(rank);
        const double area = (std::min(domain.along.high, 14.0) - std::max(domain.along.low, 0.0)) *
                            (std::min(domain.across.high, 6.0) - std::max(domain.across.low, 0.0));
        CHECK(area == Approx(12));
    }
    CHECK(carrom::shares_below_cuts(sizes) == std::vector<double>{2.0 / 7, 4.0 / 7});
}
