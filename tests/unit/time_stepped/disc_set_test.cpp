// SPDX-License-Identifier: BSD-3-Clause
// The set of discs compared with the standard library's set.
#include "catch.hpp"

#include <random>
#include <set>

#include "time_stepped/disc_set.hpp"

using namespace carrom;

TEST_CASE("sets of discs hold what was put in since they were emptied") {
    std::mt19937 random(5);
    DiscSet set;
    for (int round = 0; round < 200; ++round) {
        set.clear();
        std::set<LocalIndex> expected;
        const LocalIndex n_discs = 1u << (random() % 14), first = random() % 2 == 0 ? 0 : 0u - 9000;
        // numbers that follow one another, or that lie far apart
        const LocalIndex stride = random() % 3 == 0 ? 4096 : 1;
        bool agree = true;
        for (unsigned k = random() % 3000; k > 0; --k) {
            const LocalIndex disc = first + stride * (random() % n_discs);
            agree = agree && set.contains(disc) == expected.contains(disc);
            agree = agree && set.insert(disc) == expected.insert(disc).second;
            agree = agree && set.contains(disc);
        }
        for (LocalIndex k = 0; k < n_discs; ++k)
            agree = agree &&
                    set.contains(first + stride * k) == expected.contains(first + stride * k);
        INFO("round " << round << ", among " << n_discs << " discs from " << first);
        CHECK(agree);
    }
}
