// SPDX-License-Identifier: BSD-3-Clause
// Decides which candidates of a micro-step (or of a part of it) happen, as far as this rank can
// decide alone.
//
// The rule is a walk in total order: keep a candidate if neither disc has one that is kept. Rounds
// give the same result: keep all candidates that are first for both discs, reject the other
// candidates of these discs, and repeat (Blelloch, Fineman, Shun 2012). Gases need one to three
// rounds. A long chain would need half as many rounds as its length, so after a few rounds the rest
// is sorted and walked. A rank has all candidates of its own discs, but not of halo discs. So a
// candidate with a halo disc stays undecided, as do all candidates that depend on it.
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
    Candidates undecided; ///< empty if there is no halo
    int n_rounds = 0;
};

/// Keeps a mark of 4 bytes for each disc of a rank. All marks are reset after each call.
class LocalResolution {
public:
    explicit LocalResolution(int n_threads) : n_threads_(n_threads) {}

    /// Decides the candidates in `live`, and empties it. Candidates of discs that already have a
    /// kept candidate must have been removed.
    void resolve(const Population& population, Candidates& live, Verdicts& verdicts);

    int rounds_before_walk = 12; ///< affects only the cost; with 0 the walk starts immediately

private:
    // One round: keeps the candidates that are first for both discs, removes all candidates of
    // these discs from `live`, and returns the number kept.
    std::size_t round_alone(const Population&, Candidates& live, Verdicts&);
    std::size_t round_together(const Population&, Candidates& live, Verdicts&);
    void make_room_for(std::size_t n_discs);
    void join_lists(Candidates& live, Verdicts&);
    void walk(const Population&, Candidates& live, Verdicts&);

    int n_threads_;
    /// For each disc the number of its first live candidate, or a mark
    RawVector<std::uint32_t> first_;
    std::vector<Candidates> kept_by_thread_, live_by_thread_;
    std::vector<std::pair<std::size_t, std::size_t>>
        places_; ///< where each thread puts its kept and live candidates
    std::vector<LocalIndex> touched_;
};

} // namespace carrom
