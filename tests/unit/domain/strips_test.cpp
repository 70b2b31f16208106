// SPDX-License-Identifier: BSD-3-Clause
// Strips compared with brute force at sampled positions, with many equal cuts.
#include "domain/strips.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "catch.hpp"

#include "strips_support.hpp"

using carrom::Strips;
using namespace carrom::test;

namespace {

/// Positions at which errors are likely: on the cuts, immediately beside them, and anywhere.
std::vector<double> probes(std::mt19937& random, const Strips& strips) {
    std::vector<double> xs = {0, box};
    for (const double cut : strips.cuts())
        for (const double x : {cut, std::nextafter(cut, -1e9), std::nextafter(cut, 1e9)})
            xs.push_back(x);
    std::uniform_real_distribution<double> anywhere(-1, box + 1);
    for (int k = 0; k < 40; ++k) xs.push_back(anywhere(random));
    return xs;
}

int owner_by_search(const Strips& strips, double x) {
    int found = -1;
    for (int k = 0; k < strips.size(); ++k)
        if (strips.low(k) <= x && x < strips.high(k)) found = found == -1 ? k : -2;
    return found;
}

} // namespace

TEST_CASE("one strip owns everything") {
    const Strips all;
    CHECK(all.size() == 1);
    CHECK(all.owner(-1e300) == 0);
    CHECK(all.owner(1e300) == 0);
    CHECK_FALSE(all.is_empty(0));
    CHECK(all.neighbours_within(0, 1e9).empty());
}

TEST_CASE("a position on a cut belongs to the strip above, past empty strips") {
    const Strips strips({2, 5, 5, 5, 8});
    CHECK(strips.owner(2) == 1);
    CHECK(strips.owner(std::nextafter(2.0, 0.0)) == 0);
    CHECK(strips.owner(5) == 4);
    CHECK(strips.is_empty(2));
    CHECK(strips.is_empty(3));
    CHECK_FALSE(strips.is_empty(4));
    CHECK(strips.of(1).meets(4, 6));
    CHECK(strips.of(4).meets(5, 5));
    CHECK_FALSE(strips.of(1).meets(5, 5));
    CHECK_FALSE(strips.of(4).meets(8, 8));
    CHECK(strips.neighbours_within(1, 0) == std::vector<int>{0, 4});
    CHECK(strips.neighbours_within(1, 2.9) == std::vector<int>{0, 4});
    CHECK(strips.neighbours_within(1, 3) == std::vector<int>{0, 4, 5});
    CHECK(strips.neighbours_within(2, 100).empty());
}

TEST_CASE("every position has one owner, found by search") {
    std::mt19937 random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const Strips strips = random_strips(random, 1 + trial % 9);
        for (const double x : probes(random, strips)) {
            REQUIRE(strips.owner(x) == owner_by_search(strips, x));
            REQUIRE_FALSE(strips.is_empty(strips.owner(x)));
        }
    }
}

TEST_CASE("an interval meets the strips between the owners of its ends") {
    std::mt19937 random(2);
    for (int trial = 0; trial < 100; ++trial) {
        const Strips strips = random_strips(random, 1 + trial % 9);
        const std::vector<double> xs = probes(random, strips);
        for (std::size_t k = 0; k + 1 < xs.size(); ++k) {
            const auto [low, high] = std::minmax(xs[k], xs[k + 1]);
            for (int rank = 0; rank < strips.size(); ++rank) {
                if (strips.is_empty(rank)) continue;
                REQUIRE(strips.of(rank).meets(low, high) ==
                        (owner_by_search(strips, low) <= rank &&
                         rank <= owner_by_search(strips, high)));
            }
        }
    }
}

TEST_CASE("neighbours are symmetric, complete for every sender, and no more than needed") {
    std::mt19937 random(3);
    for (int trial = 0; trial < 300; ++trial) {
        const Strips strips = random_strips(random, 1 + trial % 9);
        const double reach = trial % 5 == 0 ? 2.0 * (trial % 3)
                                            : std::uniform_real_distribution<double>(0, 4)(random);
        std::vector<std::vector<int>> lists;
        for (int rank = 0; rank < strips.size(); ++rank)
            lists.push_back(strips.neighbours_within(rank, reach));
        check_lists(lists);
        for (const double x : probes(random, strips)) {
            const int own = strips.owner(x);
            for (int rank = 0; rank < strips.size(); ++rank) {
                if (rank == own || strips.is_empty(rank) ||
                    !strips.of(rank).meets(x - reach, x + reach))
                    continue;
                REQUIRE(contains(lists[static_cast<std::size_t>(own)], rank));
            }
        }
        for (int a = 0; a < strips.size(); ++a)
            for (const int b : lists[static_cast<std::size_t>(a)]) {
                REQUIRE_FALSE(strips.is_empty(b));
                REQUIRE(strips.low(std::max(a, b)) - strips.high(std::min(a, b)) <=
                        reach * (1 + 1e-12) + 1e-12);
            }
    }
}

TEST_CASE("neighbours are complete where x + reach rounds onto a cut") {
    // The gap between the cuts rounds to more than the reach, but a disc just below the lower cut
    // reaches the upper one.
    const double lower = 0x1p-52 * (1 + 0x1p-50), upper = 1 + 0x1p-52, reach = 1 - 0x1p-53;
    REQUIRE(upper - lower > reach);
    const Strips strips({lower, upper});
    const double x = std::nextafter(lower, 0.0);
    CHECK(strips.of(2).meets(x - reach, x + reach));
    CHECK(strips.neighbours_within(0, reach) == std::vector<int>{1, 2});
    CHECK(strips.neighbours_within(2, reach) == std::vector<int>{0, 1});
}

TEST_CASE("balanced cuts halve, quarter and interpolate") {
    using Weights = std::vector<std::uint64_t>;
    using Shares = std::vector<double>;
    const Shares quarters = {0.25, 0.5, 0.75}, half = {0.5};
    CHECK(carrom::balanced_cuts(Weights{1, 1, 1, 1}, 8, quarters) == std::vector<double>{2, 4, 6});
    CHECK(carrom::balanced_cuts(Weights{3, 1}, 8, half) == std::vector<double>{4.0 * 2 / 3});
    CHECK(carrom::balanced_cuts(Weights{0, 0, 0, 8}, 8, quarters) ==
          std::vector<double>{6.5, 7, 7.5});
    CHECK(carrom::balanced_cuts(Weights{0, 0}, 8, half) == std::vector<double>{4});
    CHECK(carrom::balanced_cuts(Weights{}, 8, quarters) == std::vector<double>{2, 4, 6});
    CHECK(carrom::balanced_cuts(Weights{2, 2}, 8, Shares{0.25, 1}) == std::vector<double>{2, 8});
    CHECK(carrom::balanced_cuts(Weights{5, 5}, 8, Shares{}).empty());
}

TEST_CASE("balanced cuts ascend within the box and share the weight evenly") {
    std::mt19937 random(5);
    for (int trial = 0; trial < 300; ++trial) {
        const std::size_t n_bins = 1 + random() % 30;
        std::vector<double> shares(random() % 12);
        for (double& share : shares) share = std::uniform_real_distribution<double>(0, 1)(random);
        std::sort(shares.begin(), shares.end());
        std::vector<std::uint64_t> weights;
        for (std::size_t k = 0; k < n_bins; ++k)
            weights.push_back(random() % 3 == 0 ? random() % 1000 : 0);
        weights[random() % n_bins] += 1;
        const std::vector<double> cuts = carrom::balanced_cuts(weights, box, shares);
        REQUIRE(cuts.size() == shares.size());
        REQUIRE(std::is_sorted(cuts.begin(), cuts.end()));
        const double total = static_cast<double>(
            std::accumulate(weights.begin(), weights.end(), std::uint64_t{0}));
        for (std::size_t k = 0; k < cuts.size(); ++k) {
            REQUIRE((0 <= cuts[k] && cuts[k] <= box));
            double below = 0; // the weight below the cut, summed over the parts of bins
            for (std::size_t bin = 0; bin < n_bins; ++bin) {
                const double part = cuts[k] / box * static_cast<double>(n_bins) -
                                    static_cast<double>(bin);
                below += static_cast<double>(weights[bin]) * std::clamp(part, 0.0, 1.0);
            }
            REQUIRE(below == Approx(total * shares[k]).epsilon(1e-9).margin(1e-9));
        }
    }
}
