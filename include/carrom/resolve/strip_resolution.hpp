// SPDX-License-Identifier: BSD-3-Clause
// Decides what no rank could decide alone: candidates that hang together across strips.
//
// The contested candidates of all ranks are brought into the total order by a distributed sort and walked, slice after
// slice, each slice told which discs the ones before it took. A candidate with discs of two ranks is contested by both
// unless one of them has struck it already: it counts only if both copies arrive. A chain may span any number of
// strips. Price: nothing but one reduction where nothing is contested; else two any-to-any exchanges, and memory for
// the contested candidates alone.
#pragma once

#include <cstdint>
#include <vector>

#include "carrom/collision/candidate.hpp"
#include "carrom/collision/search.hpp"
#include "carrom/parallel/communicator.hpp"
#include "carrom/parallel/neighbour_exchange.hpp"

namespace carrom {

class StripResolution {
public:
    explicit StripResolution(const Communicator& communicator)
        : communicator_(communicator), next_slice_(communicator) {}

    /// Appends to `kept` those of this rank's `undecided` that happen. `n_contested` is their number over all ranks,
    /// not 0. **Collective.**
    void decide(const Population& population, std::vector<Candidate>& undecided, std::uint64_t n_contested,
                std::vector<Candidate>& kept);

    std::uint64_t candidates_per_slice = 8192; ///< cost only

private:
    struct Contested;
    std::vector<Contested> walk(const std::vector<Contested>& slice, std::vector<DiscId>& taken) const;

    Communicator communicator_;
    NeighbourExchange next_slice_;
};

} // namespace carrom
