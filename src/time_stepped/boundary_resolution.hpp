// SPDX-License-Identifier: BSD-3-Clause
// Decides chains of candidates with common discs that extend over several strips, so that no rank
// can decide them alone (docs/understanding/method.md, section 7).
//
// First, neighbours exchange messages. For every candidate with discs of two ranks, each rank
// reports whether it is the first remaining candidate of its own disc. A candidate that is first
// for both is kept. If only one of the ranks reports a candidate, the other one has rejected it.
// In a gas, one message to each neighbour decides nearly all candidates on any number of ranks.
//
// A chain that zigzags between strips takes a round for each crossing. So after a few rounds the
// remaining candidates are sorted across the ranks into the total order. Ranks then walk their
// slices in turn, and pass on the ids of discs that collide. So a chain may span any number of
// strips. Cost of the sort: two any-to-any exchanges, and memory for these candidates only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "parallel/communicator.hpp"
#include "parallel/neighbour_exchange.hpp"
#include "time_stepped/candidate.hpp"
#include "time_stepped/disc_set.hpp"
#include "time_stepped/search.hpp"

namespace carrom {

class BoundaryResolution {
public:
    explicit BoundaryResolution(const Communicator& communicator)
        : communicator_(communicator), with_neighbours_(communicator), next_slice_(communicator) {}

    /// Exchanges messages once with `neighbours`, which are all ranks that own discs of this rank's
    /// halo or have this rank's discs in their halos. Then moves candidates of `undecided` that
    /// certainly happen to `kept`, and drops the rejected ones. **Collective.**
    void resolve_boundary(const Population& population, std::span<const int> neighbours,
                          Candidates& undecided, Candidates& kept);

    /// Decides all `undecided` candidates of this rank, and appends those that happen to `kept`.
    /// `n_conflicts` is the number of undecided candidates on all ranks. **Collective.**
    void decide(const Population& population, std::span<const int> neighbours,
                Candidates& undecided, std::uint64_t n_conflicts, Candidates& kept);

    int rounds_before_sort = 6; ///< rounds of messages before the sort; affects only the cost
    std::uint64_t candidates_per_slice = 8192; ///< smallest size of a slice; affects only the cost

private:
    struct Conflict;
    struct Statement;
    void find_first(const Population& population, const Candidates& undecided);
    void walk_own(const Population& population, const std::vector<std::uint8_t>& is_struck,
                  Candidates& undecided, Candidates& kept);
    void keep(const Candidate& candidate, Candidates& kept);
    void sort(const Population& population, Candidates& undecided, std::uint64_t n_conflicts,
              Candidates& kept);
    std::vector<Conflict> walk(const std::vector<Conflict>& slice,
                               std::vector<DiscId>& taken) const;

    Communicator communicator_;
    NeighbourExchange with_neighbours_, next_slice_;
    std::vector<std::uint8_t>
        is_first_; ///< whether each undecided candidate is the first one of each of its own discs
    DiscSet seen_, taken_;
};

} // namespace carrom
