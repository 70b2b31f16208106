// SPDX-License-Identifier: BSD-3-Clause
// Plans and packs transfers with all threads of a rank. Only sources in this folder use it. With
// one planning thread, all other threads would wait once or twice a window.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "cell_list/shared_work.hpp"
#include "core/raw_vector.hpp"
#include "domain/transfer.hpp"

namespace carrom {

/// With fewer discs, threads cost more than they save. The limit for planning is lower, because
/// planning a disc takes several times as long as packing it.
inline constexpr std::size_t least_for_threads = 4096, least_planned_on_threads = 512;

/// Calls visit(place) for the elements first .. last - 1 of the list of all places in `ranges`.
template <class Visit>
void visit_places(std::span<const PlaceRange> ranges, std::size_t first, std::size_t last,
                  const Visit& visit) {
    std::size_t n_before = 0; // number of places in earlier ranges
    for (const PlaceRange range : ranges) {
        const std::size_t end = n_before + (range.end - range.begin);
        for (std::size_t k = std::max(first, n_before); k < std::min(last, end); ++k)
            visit(static_cast<LocalIndex>(range.begin + (k - n_before)));
        n_before = end;
    }
}

/// Each thread searches a part of the places in `searched`. `visit(place, leaving)` appends to the
/// lists of that part, which are then appended to the lists of `plan` in the order of places.
template <class Visit>
void plan_in_parts(TransferPlan& plan, std::span<const PlaceRange> searched, int n_threads,
                   const Visit& visit) {
    std::size_t n_searched = 0;
    for (const PlaceRange range : searched) n_searched += range.end - range.begin;
    if (n_threads == 1 || n_searched < least_planned_on_threads) {
        visit_places(searched, 0, n_searched, [&](LocalIndex place) { visit(place, plan); });
        return;
    }
    const auto n_parts = static_cast<std::size_t>(n_threads);
    std::vector<LeavingDiscs> parts(n_parts);
#pragma omp parallel for num_threads(n_threads) schedule(static, 1)
    for (std::size_t k = 0; k < n_parts; ++k) {
        // A copy with empty lists: threads that write to `parts` directly would share cache lines
        LeavingDiscs part = plan;
        visit_places(searched, share(n_searched, k, n_parts), share(n_searched, k + 1, n_parts),
                     [&](LocalIndex place) { visit(place, part); });
        parts[k] = std::move(part);
    }
    const auto append = [](auto& lists, const auto& more) {
        for (std::size_t k = 0; k < lists.size(); ++k)
            lists[k].insert(lists[k].end(), more[k].begin(), more[k].end());
    };
    for (const LeavingDiscs& part : parts) {
        append(plan.leaving, part.leaving);
        append(plan.images, part.images);
    }
}

/// Like `transfer`, but sends pack(value, k, i) instead of the i-th value for partner k.
template <class Values, class Pack>
std::vector<std::size_t> transfer_packed(NeighbourExchange& exchange, const TransferPlan& plan,
                                         const Values& values, Values& arrived, int n_threads,
                                         const Pack& pack) {
    std::vector<RawVector<typename Values::value_type>> out(plan.partners.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
        const std::vector<LocalIndex>& leaving = plan.leaving[k];
        out[k].resize(leaving.size());
#pragma omp parallel for num_threads(n_threads)                                                    \
    schedule(static) if (leaving.size() >= least_for_threads)
        for (std::size_t i = 0; i < leaving.size(); ++i) out[k][i] = pack(values[leaving[i]], k, i);
    }
    return exchange.append(std::span<const int>(plan.partners), out, arrived);
}

} // namespace carrom
