// SPDX-License-Identifier: BSD-3-Clause
// Gathers items of all ranks on every rank, for tests with few discs.
#pragma once

#include <span>
#include <vector>

#include "parallel/communicator.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

/// The items in the order of ranks. **Collective.**
template <class Items> auto gathered(const Items& mine, const Communicator& world) {
    using Item = typename Items::value_type;
    std::vector<Item> all;
    stream_to_root(
        world, std::span<const Item>(mine),
        [&](std::span<const Item> some) { all.insert(all.end(), some.begin(), some.end()); },
        10000);
    world.broadcast(all);
    return all;
}

} // namespace carrom
