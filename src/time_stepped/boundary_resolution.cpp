// SPDX-License-Identifier: BSD-3-Clause
#include "time_stepped/boundary_resolution.hpp"

#include <algorithm>
#include <span>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "parallel/sample_sort.hpp"

namespace carrom {

/// A candidate in a message: its key in the total order, and where the decision must be sent.
struct BoundaryResolution::Conflict {
    double time;
    DiscId p;
    std::uint64_t second; ///< 0 for a wall, so that a wall comes first; else 1 + the id of Q
    std::int32_t rank;
    std::uint32_t number;
    std::uint32_t n_copies; ///< number of ranks that have the candidate if no rank has rejected it

    auto key() const { return std::tuple(time, p, second); }
};

/// A rank's report about a candidate that has one disc of this rank and one disc of another rank.
struct BoundaryResolution::Statement {
    double time;
    DiscId p, q;
    /// Number in the list of undecided candidates of the rank that reports it
    std::uint32_t number;
    std::uint16_t is_first; ///< 1 if the candidate is the first remaining one of this rank's disc
    std::uint16_t is_mine = 0; ///< 1 if this rank made the statement, 0 if it was received

    auto key() const { return std::tuple(time, p, q); }
};

namespace {

bool is_shared(const Candidate& c, const Population& population) {
    return c.p >= population.n_own || (!c.is_wall() && c.q >= population.n_own);
}

void insert(const Candidate& c, DiscSet& set) {
    set.insert(c.p);
    if (!c.is_wall()) set.insert(c.q);
}

bool has_disc_of(const Candidate& c, const DiscSet& set) {
    return set.contains(c.p) || (!c.is_wall() && set.contains(c.q));
}

} // namespace

void BoundaryResolution::resolve_boundary(const Population& population,
                                          std::span<const int> neighbours, Candidates& undecided,
                                          Candidates& kept) {
    std::sort(undecided.begin(), undecided.end(), TotalOrder(population.discs));
    find_first(population, undecided);
    std::vector<Statement> mine;
    for (std::size_t k = 0; k < undecided.size(); ++k) {
        const Candidate& c = undecided[k];
        if (!is_shared(c, population)) continue;
        mine.push_back({c.time, population.discs[c.p].id, population.discs[c.q].id,
                        static_cast<std::uint32_t>(k), is_first_[k]});
    }
    // This rank has no table of which neighbour owns the other disc, so it sends its few
    // statements to all neighbours.
    Received<Statement> received;
    with_neighbours_.exchange(neighbours, std::vector(neighbours.size(), mine), received);
    for (Statement& statement : mine) statement.is_mine = 1;
    mine.insert(mine.end(), received.items.begin(), received.items.end());
    std::sort(mine.begin(), mine.end(),
              [](const Statement& a, const Statement& b) { return a.key() < b.key(); });

    std::vector<std::uint8_t> is_struck(undecided.size(), 0);
    taken_.clear();
    for (std::size_t begin = 0, end = 0; begin < mine.size(); begin = end) {
        bool are_first = true;
        for (end = begin; end < mine.size() && mine[end].key() == mine[begin].key(); ++end)
            are_first = are_first && mine[end].is_first != 0;
        // if false, one of the two ranks has rejected the candidate
        const bool is_named_by_both = end - begin >= 2;
        for (std::size_t k = begin; k < end; ++k) {
            if (mine[k].is_mine == 0 || (is_named_by_both && !are_first)) continue;
            is_struck[mine[k].number] = 1;
            if (is_named_by_both) keep(undecided[mine[k].number], kept);
        }
    }
    walk_own(population, is_struck, undecided, kept);
}

void BoundaryResolution::keep(const Candidate& candidate, Candidates& kept) {
    kept.push_back(candidate);
    insert(candidate, taken_);
}

/// Fills `is_first_`: whether each undecided candidate (in total order) is the first one of each of
/// its discs that this rank owns.
void BoundaryResolution::find_first(const Population& population, const Candidates& undecided) {
    is_first_.clear();
    seen_.clear();
    for (const Candidate& c : undecided) {
        bool is_first = true;
        for (const LocalIndex index : {c.p, c.q})
            if (index < population.n_own && !seen_.insert(index)) is_first = false;
        is_first_.push_back(is_first ? 1 : 0);
    }
}

/// Keeps or rejects the candidates that this rank can decide alone. Candidates that are marked in
/// `is_struck` have already been decided; if they were kept, their discs are in `taken_`.
void BoundaryResolution::walk_own(const Population& population,
                                  const std::vector<std::uint8_t>& is_struck, Candidates& undecided,
                                  Candidates& kept) {
    seen_.clear(); // discs that have an earlier candidate that stays undecided
    std::size_t n_left = 0;
    for (std::size_t k = 0; k < undecided.size(); ++k) {
        const Candidate c = undecided[k];
        if (is_struck[k] != 0 || has_disc_of(c, taken_)) continue;
        if (is_shared(c, population) || has_disc_of(c, seen_)) {
            undecided[n_left++] = c;
            insert(c, seen_);
        } else {
            keep(c, kept);
        }
    }
    undecided.resize(n_left);
}

void BoundaryResolution::decide(const Population& population, std::span<const int> neighbours,
                                Candidates& undecided, std::uint64_t n_conflicts,
                                Candidates& kept) {
    for (int round = 0; round < rounds_before_sort && n_conflicts > 0; ++round) {
        resolve_boundary(population, neighbours, undecided, kept);
        n_conflicts = communicator_.sum(std::uint64_t{undecided.size()});
    }
    if (n_conflicts > 0) sort(population, undecided, n_conflicts, kept);
}

void BoundaryResolution::sort(const Population& population, Candidates& undecided,
                              std::uint64_t n_conflicts, Candidates& kept) {
    std::vector<Conflict> mine;
    mine.reserve(undecided.size());
    for (std::size_t k = 0; k < undecided.size(); ++k) {
        const Candidate& c = undecided[k];
        mine.push_back({c.time, population.discs[c.p].id,
                        c.is_wall() ? 0 : population.discs[c.q].id + 1, communicator_.rank(),
                        static_cast<std::uint32_t>(k), is_shared(c, population) ? 2u : 1u});
    }
    const auto before = [](const Conflict& a, const Conflict& b) { return a.key() < b.key(); };
    const auto n_ranks = static_cast<std::uint64_t>(communicator_.size());
    const auto n_slices = static_cast<int>(
        std::clamp<std::uint64_t>(n_conflicts / candidates_per_slice, 1, n_ranks));
    const std::vector<Conflict> slice = sample_sort(communicator_, std::move(mine), before,
                                                    n_slices);

    std::vector<std::vector<std::uint32_t>> verdicts(n_ranks);
    std::vector<DiscId> taken;
    Received<DiscId> handed_on;
    for (int turn = 0; turn < n_slices; ++turn) {
        if (communicator_.rank() == turn) {
            for (const Conflict& c : walk(slice, taken))
                verdicts[static_cast<std::size_t>(c.rank)].push_back(c.number);
        }
        if (turn + 1 == n_slices) break;
        std::vector<int> partner;
        if (communicator_.rank() == turn) partner = {turn + 1};
        if (communicator_.rank() == turn + 1) partner = {turn};
        std::vector<std::vector<DiscId>> out(partner.size());
        if (communicator_.rank() == turn) out.front() = std::exchange(taken, {});
        next_slice_.exchange(std::span<const int>(partner), out, handed_on);
        if (communicator_.rank() == turn + 1) taken = handed_on.items;
    }
    for (const std::uint32_t number : send_to_owners(communicator_, verdicts).items)
        kept.push_back(undecided[number]);
    undecided.clear();
}

/// Returns all copies of those candidates of a sorted slice that happen, and adds their discs to
/// `taken`.
std::vector<BoundaryResolution::Conflict> BoundaryResolution::walk(
    const std::vector<Conflict>& slice, std::vector<DiscId>& taken) const {
    std::unordered_set<DiscId> is_taken(taken.begin(), taken.end());
    std::vector<Conflict> kept;
    for (std::size_t begin = 0, end = 0; begin < slice.size(); begin = end) {
        const Conflict& c = slice[begin];
        while (end < slice.size() && slice[end].key() == c.key()) ++end;
        if (end - begin != c.n_copies) continue; // one of the ranks has rejected the candidate
        const bool is_wall = c.second == 0;
        if (is_taken.contains(c.p) || (!is_wall && is_taken.contains(c.second - 1))) continue;
        is_taken.insert(c.p);
        taken.push_back(c.p);
        if (!is_wall) {
            is_taken.insert(c.second - 1);
            taken.push_back(c.second - 1);
        }
        kept.insert(kept.end(), slice.begin() + static_cast<std::ptrdiff_t>(begin),
                    slice.begin() + static_cast<std::ptrdiff_t>(end));
    }
    return kept;
}

} // namespace carrom
