// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/insertion_box.hpp"

#include <vector>

#include "parallel/exchange.hpp"

namespace carrom {

void InsertionBox::propose(std::span<const std::uint32_t> ids, std::uint64_t first_round,
                           std::uint64_t n_rounds, int n_threads, RawVector<Notice>& made) const {
    const std::size_t n = ids.size();
    made.resize(n * n_rounds);
#pragma omp parallel for num_threads(n_threads) schedule(static)
    for (std::size_t k = 0; k < made.size(); ++k) {
        const std::uint32_t id = ids[k % n];
        const Point place = proposal(id, first_round + k / n);
        made[k] = {place.x, place.y, id, static_cast<std::uint32_t>(k / n)};
    }
}

void InsertionBox::deliver(RawVector<Notice>& notices, std::span<const Notice> updates,
                           int n_threads) const {
    if (communicator_.size() == 1) return;
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
    notices.assign(arrived.begin(), arrived.end());
}

} // namespace carrom
