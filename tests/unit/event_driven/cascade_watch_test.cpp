// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/cascade_watch.hpp"

#include "catch.hpp"

using namespace carrom;

namespace {

/// The number of collisions of ten discs, `apart` micro-steps from each other, until the watch ends
/// them; at most ten million.
std::uint64_t collisions_until_end(double apart, bool are_with_walls = false) {
    CascadeWatch watch;
    std::uint64_t n = 0;
    while (n < 10000000 && !watch.add(static_cast<double>(n) * apart, 0x1p-40, 10, are_with_walls))
        ++n;
    return n;
}

} // namespace

TEST_CASE("collisions at one time, or without end in a slot, are seen, and frequent ones are not") {
    CHECK(collisions_until_end(0) == 110000);
    // A disc of speed 0.01 in a slot that is 2e-15 wider than itself.
    CHECK(collisions_until_end(2e-13) == 5500000);
    // A million collisions in a micro-step take a second, and end.
    CHECK(collisions_until_end(1e-6) == 10000000);
    CHECK(collisions_until_end(1e-11) == 10000000);
    // In a wedge whose surfaces drive a disc all collisions are with walls.
    CHECK(collisions_until_end(2e-13, true) == 220000);
    CHECK(collisions_until_end(1e-9, true) == 10000000);
}
