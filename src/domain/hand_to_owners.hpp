// SPDX-License-Identifier: BSD-3-Clause
// Sends discs to their owners at the start of a run, with little extra memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "parallel/exchange.hpp"

namespace carrom {

/// Moves each value to the rank `owner_of(i)`, where i is the value's index before the call.
/// `owner_of(i)` may read `values[i]`, which is not overwritten before this call. Values are sent
/// in rounds, and arriving values take the places of values that were sent. Sending all values
/// together would take two or three times their memory. **Collective.**
template <class Values, class Owner>
void hand_to_owners(const Communicator& communicator, Values& values, const Owner& owner_of) {
    using T = typename Values::value_type;
    constexpr std::size_t n_rounds = 32;
    const std::size_t n = values.size(), rank = static_cast<std::size_t>(communicator.rank());
    std::vector<T> waiting; // arrived values for which no place is free yet
    std::size_t n_kept = 0;
    for (std::size_t round = 0; round < n_rounds; ++round) {
        std::vector<std::vector<T>> out(static_cast<std::size_t>(communicator.size()));
        const std::size_t end = n * (round + 1) / n_rounds;
        for (std::size_t i = n * round / n_rounds; i < end; ++i) {
            const std::size_t owner = owner_of(i);
            if (owner == rank)
                values[n_kept++] = values[i];
            else
                out[owner].push_back(values[i]);
        }
        const std::vector<T> arrived = send_to_owners(communicator, out).items;
        waiting.insert(waiting.end(), arrived.begin(), arrived.end());
        const std::size_t n_placed = std::min(waiting.size(), end - n_kept);
        std::copy(waiting.end() - static_cast<std::ptrdiff_t>(n_placed), waiting.end(),
                  values.begin() + static_cast<std::ptrdiff_t>(n_kept));
        n_kept += n_placed;
        waiting.resize(waiting.size() - n_placed);
    }
    values.resize(n_kept);
    values.insert(values.end(), waiting.begin(), waiting.end());
}

} // namespace carrom
