// SPDX-License-Identifier: BSD-3-Clause
// Random strips, and requirements of lists of ranks that exchange discs, for strips and for
// domains.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "catch.hpp"

#include "domain/strips.hpp"

namespace carrom::test {

inline constexpr double box = 10;

/// Cuts of the box. Half of the time they are on a coarse lattice, so that equal cuts and cuts at
/// the ends are frequent.
inline Strips random_strips(std::mt19937& random, int n_strips, Axis axis = Axis::x) {
    std::uniform_real_distribution<double> anywhere(0, box);
    const bool coarse = random() % 2 == 0;
    std::vector<double> cuts;
    for (int k = 1; k < n_strips; ++k)
        cuts.push_back(coarse ? std::round(anywhere(random) / 2) * 2 : anywhere(random));
    std::sort(cuts.begin(), cuts.end());
    return Strips(std::move(cuts), axis);
}

inline bool contains(const std::vector<int>& list, int rank) {
    return std::find(list.begin(), list.end(), rank) != list.end();
}

/// Checks lists by rank: each ascends and does not contain the rank itself, and a lists b if and
/// only if b lists a.
inline void check_lists(const std::vector<std::vector<int>>& lists) {
    for (std::size_t a = 0; a < lists.size(); ++a) {
        REQUIRE(std::is_sorted(lists[a].begin(), lists[a].end()));
        REQUIRE(std::set<int>(lists[a].begin(), lists[a].end()).size() == lists[a].size());
        REQUIRE_FALSE(contains(lists[a], static_cast<int>(a)));
        for (const int b : lists[a])
            REQUIRE(contains(lists[static_cast<std::size_t>(b)], static_cast<int>(a)));
    }
}

} // namespace carrom::test
