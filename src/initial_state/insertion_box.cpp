// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/insertion_box.hpp"

#include <algorithm>
#include <vector>

#include "parallel/exchange.hpp"

namespace carrom {

namespace {

/// Each rank sends about this many proposals at a time, because the sent and the received copies
/// each take as much memory as the proposals themselves.
constexpr double most_at_once = 1 << 16;

} // namespace

void InsertionBox::propose(const Proposers& proposers, std::span<const Notice> updates,
                           int n_threads, RawVector<Notice>& concerning) const {
    const std::uint64_t n = proposers.ids.size() * proposers.n_rounds;
    concerning.clear();
    if (communicator_.size() == 1) return make_proposals(proposers, 0, n, n_threads, concerning);
    // Reserves all memory now, because a growing list is copied and so needs more than twice its
    // size. Reserved memory takes no space before it is used.
    concerning.reserve(static_cast<std::size_t>(1.1 * static_cast<double>(n + updates.size())) +
                       1000);
    const double n_of_rank = static_cast<double>(proposers.n_of_all * proposers.n_rounds) /
                             communicator_.size(); // the same number on all ranks
    const auto n_parts = static_cast<std::uint64_t>(std::min(n_of_rank, share()) / most_at_once) +
                         1;
    RawVector<Notice> made;
    for (std::uint64_t part = 0; part < n_parts; ++part) {
        make_proposals(proposers, n * part / n_parts, n * (part + 1) / n_parts, n_threads, made);
        const std::size_t first = updates.size() * part / n_parts,
                          end = updates.size() * (part + 1) / n_parts;
        deliver(made, updates.subspan(first, end - first), n_threads, concerning);
    }
}

std::vector<Notice> InsertionBox::gather(const std::vector<InputDisc>& given) const {
    std::vector<std::vector<Notice>> out(n_ranks());
    for (const InputDisc& disc : given) {
        const auto [x, y] = turned(axis_, disc.x, disc.y);
        const Notice notice{x, y, static_cast<std::uint32_t>(disc.id), Notice::placed};
        visit_concerned(x, [&](std::size_t rank) { out[rank].push_back(notice); });
    }
    std::vector<Notice> all = send_to_owners(communicator_, out).items;
    std::ranges::sort(all, {}, &Notice::id); // sorted, so that the grid is the same in every run
    return all;
}

/// Makes this rank's proposals `first` to `end` - 1, numbered by round, then by disc.
void InsertionBox::make_proposals(const Proposers& proposers, std::uint64_t first,
                                  std::uint64_t end, int n_threads, RawVector<Notice>& made) const {
    const std::size_t n = proposers.ids.size();
    made.resize(end - first);
#pragma omp parallel for num_threads(n_threads) schedule(static)
    for (std::size_t i = 0; i < made.size(); ++i) {
        const std::size_t k = first + i;
        const std::uint32_t id = proposers.ids[k % n];
        const Point place = proposal(id, proposers.first_round + k / n);
        made[i] = {place.x, place.y, id, static_cast<std::uint32_t>(k / n)};
    }
}

/// Sends notices to the ranks that need them, and appends received notices to `concerning`. A rank
/// does not send updates to itself. **Collective.**
void InsertionBox::deliver(std::span<const Notice> notices, std::span<const Notice> updates,
                           int n_threads, RawVector<Notice>& concerning) const {
    std::vector<std::vector<Notice>> out(n_ranks());
    for (const Notice& update : updates)
        visit_concerned(update.x, [&](std::size_t rank) {
            if (!is_me(rank)) out[rank].push_back(update);
        });
#pragma omp parallel num_threads(n_threads)
    {
        std::vector<std::vector<Notice>> mine(n_ranks());
#pragma omp for schedule(static) nowait
        for (std::size_t k = 0; k < notices.size(); ++k)
            visit_concerned(notices[k].x,
                            [&](std::size_t rank) { mine[rank].push_back(notices[k]); });
#pragma omp critical
        for (std::size_t rank = 0; rank < out.size(); ++rank)
            out[rank].insert(out[rank].end(), mine[rank].begin(), mine[rank].end());
    }
    const std::vector<Notice> arrived = send_to_owners(communicator_, out).items;
    concerning.insert(concerning.end(), arrived.begin(), arrived.end());
}

} // namespace carrom
