// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a state that files contain, written and read back.
#include "catch.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/disc_columns.hpp"

using namespace carrom;

namespace {

DiscState there_and_back(const DiscState& disc) {
    DiscState back;
    for (const StateColumn& column : disc_columns) {
        std::array<std::byte, 8> number{};
        column.put({&disc, 1}, number.data());
        std::uint64_t bits = 0;
        std::memcpy(&bits, number.data(), sizeof bits);
        column.set(back, bits);
    }
    return back;
}

} // namespace

TEST_CASE("disc columns: a collision at the time of a sync is told from the sync") {
    for (const double tau : {0.0, 3.5}) {
        for (const bool has_collided : {true, false}) {
            // without a collision tau > 0 only in the time-stepped method, after a stop
            if (tau > 0 && !has_collided) continue;
            DiscState disc;
            disc.tau = tau;
            disc.has_collided = has_collided;
            const DiscState back = there_and_back(disc);
            CHECK(back.tau == tau);
            CHECK_FALSE(std::signbit(back.tau));
            CHECK(back.has_collided == has_collided);
            CHECK_FALSE(back.has_departed());
        }
    }
}

TEST_CASE("disc columns: a departed disc has no time") {
    DiscState disc;
    disc.has_collided = 1;
    disc.depart();
    const DiscState back = there_and_back(disc);
    CHECK(back.has_departed());
    CHECK(back.tau == 0);
}
