// SPDX-License-Identifier: BSD-3-Clause
// Decides which candidates of one micro-step (or part of one) happen, as far as this rank can.
//
// The rule is the sorted walk: keep a candidate if neither of its discs is taken yet. A candidate
// that is first for both its discs is final, whatever comes later. To take all such, strike their
// rivals and repeat gives the same result (Blelloch, Fineman, Shun 2012). Gases need one to three
// rounds. A long chain would need as many rounds as half its length, so after a few the rest is
// sorted and walked. A rank knows all candidates of its own discs, not those of halo discs. So a
// candidate with a halo disc blocks its discs and stays undecided, with all that depend on it.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "time_stepped/candidate.hpp"
#include "time_stepped/search.hpp"

namespace carrom {

struct Verdicts {
    Candidates kept;
    Candidates undecided; ///< empty without a halo
    int n_rounds = 0;
};

/// Marks of all discs of a rank, kept clean between calls: 4 bytes a disc.
class LocalResolution {
public:
    explicit LocalResolution(int n_threads) : n_threads_(n_threads) {}

    /// Decides `live`, which is used up. None of its discs is taken at the start.
    void resolve(const Population& population, Candidates& live, Verdicts& verdicts);

    int rounds_before_walk = 12; ///< affects the cost only; 0 walks at once

private:
    // One round: keeps the candidates that are first for both discs, strikes their
    // rivals from `live`, and returns how many it has kept.
    std::size_t round_alone(const Population&, Candidates& live, Verdicts&);
    std::size_t round_together(const Population&, Candidates& live, Verdicts&);
    void make_room_for(std::size_t n_discs);
    void join_lists(Candidates& live, Verdicts&);
    void walk(const Population&, Candidates& live, Verdicts&);

    int n_threads_;
    RawVector<std::uint32_t> first_; ///< by disc: the number of its first live candidate, or a mark
    std::vector<Candidates> kept_by_thread_, live_by_thread_;
    std::vector<std::pair<std::size_t, std::size_t>>
        places_; ///< where a thread's kept and live candidates go
    std::vector<LocalIndex> touched_;
};

} // namespace carrom
