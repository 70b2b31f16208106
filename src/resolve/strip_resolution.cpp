// SPDX-License-Identifier: BSD-3-Clause
#include "carrom/resolve/strip_resolution.hpp"

#include <algorithm>
#include <span>
#include <tuple>
#include <unordered_set>

#include "carrom/parallel/sample_sort.hpp"

namespace carrom {

/// A candidate as it travels: its key in the total order, and where its verdict has to go.
struct StripResolution::Contested {
    double time;
    DiscId p;
    std::uint64_t second; ///< 0 for a wall, so that it comes first, else 1 + the id of Q
    std::int32_t rank;
    std::uint32_t number;
    std::uint32_t n_copies; ///< how many ranks hold it unless one has struck it

    auto key() const { return std::tuple(time, p, second); }
};

void StripResolution::decide(const Population& population, std::vector<Candidate>& undecided, std::uint64_t n_contested,
                             std::vector<Candidate>& kept) {
    std::vector<Contested> mine;
    mine.reserve(undecided.size());
    for (std::size_t k = 0; k < undecided.size(); ++k) {
        const Candidate& c = undecided[k];
        const bool is_shared = c.p >= population.n_own || (!c.is_wall() && c.q >= population.n_own);
        mine.push_back({c.time, population.discs[c.p].id, c.is_wall() ? 0 : population.discs[c.q].id + 1,
                        communicator_.rank(), static_cast<std::uint32_t>(k), is_shared ? 2u : 1u});
    }
    const auto before = [](const Contested& a, const Contested& b) { return a.key() < b.key(); };
    const auto n_ranks = static_cast<std::uint64_t>(communicator_.size());
    const auto n_slices = static_cast<int>(std::clamp<std::uint64_t>(n_contested / candidates_per_slice, 1, n_ranks));
    const std::vector<Contested> slice = sample_sort(communicator_, std::move(mine), before, n_slices);

    std::vector<std::vector<std::uint32_t>> verdicts(n_ranks);
    std::vector<DiscId> taken;
    Received<DiscId> handed_on;
    for (int turn = 0; turn < n_slices; ++turn) {
        if (communicator_.rank() == turn) {
            for (const Contested& c : walk(slice, taken)) verdicts[static_cast<std::size_t>(c.rank)].push_back(c.number);
        }
        if (turn + 1 == n_slices) break;
        std::vector<int> partner;
        if (communicator_.rank() == turn) partner = {turn + 1};
        if (communicator_.rank() == turn + 1) partner = {turn};
        std::vector<std::vector<DiscId>> out(partner.size());
        if (communicator_.rank() == turn) out.front() = std::move(taken);
        next_slice_.exchange(std::span<const int>(partner), out, handed_on);
        if (communicator_.rank() == turn + 1) taken = handed_on.items;
    }
    for (const std::uint32_t number : send_to_owners(communicator_, verdicts).items) kept.push_back(undecided[number]);
    undecided.clear();
}

/// The candidates of a sorted slice that happen, all copies of each; `taken` grows by their discs.
std::vector<StripResolution::Contested> StripResolution::walk(const std::vector<Contested>& slice,
                                                              std::vector<DiscId>& taken) const {
    std::unordered_set<DiscId> is_taken(taken.begin(), taken.end());
    std::vector<Contested> kept;
    for (std::size_t begin = 0, end = 0; begin < slice.size(); begin = end) {
        const Contested& c = slice[begin];
        while (end < slice.size() && slice[end].key() == c.key()) ++end;
        if (end - begin != c.n_copies) continue; // one of its ranks has struck it
        const bool is_wall = c.second == 0;
        if (is_taken.contains(c.p) || (!is_wall && is_taken.contains(c.second - 1))) continue;
        is_taken.insert(c.p);
        taken.push_back(c.p);
        if (!is_wall) {
            is_taken.insert(c.second - 1);
            taken.push_back(c.second - 1);
        }
        kept.insert(kept.end(), slice.begin() + static_cast<std::ptrdiff_t>(begin), slice.begin() + static_cast<std::ptrdiff_t>(end));
    }
    return kept;
}

} // namespace carrom
