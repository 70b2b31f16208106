// SPDX-License-Identifier: BSD-3-Clause
// Plans halos, extends the halos of some ranks, and reports halo discs to their owners.
#include <algorithm>

#include "core/errors.hpp"
#include "domain/strip_discs.hpp"

namespace carrom {

TransferPlan StripDiscs::plan_of_halo(double time, const HaloDepth& depth) const {
    const int rank = communicator_.rank();
    const std::vector<PlaceRange> searched = places_outside(
        interior(domains_, rank, depth.reach, periods_));
    if (periods_.are_any())
        return plan_periodic_halo(domains_, rank, own(), searched, time, depth, periods_,
                                  n_threads_);
    return plan_halo(domains_, rank, own(), searched, time, depth, n_threads_);
}

/// Neighbours first exchange whether they need more halo. A pair of ranks exchanges discs only if
/// at least one of the two needs more.
void StripDiscs::fetch_more_halo(double time, double beyond, double reach, bool wants) {
    if (has_no_halo()) return;
    const std::vector<int> near = halo_partners(domains_, communicator_.rank(), reach, periods_);
    Received<std::uint8_t> answers;
    exchange_.exchange(std::span<const int>(near),
                       std::vector(near.size(), std::vector<std::uint8_t>{wants}), answers);
    const bool are_any_wanted = std::ranges::find(answers.items, 1) != answers.items.end();
    TransferPlan all;
    if (are_any_wanted) all = plan_of_halo(time, {reach, beyond});
    HaloPart part;
    for (std::size_t k = 0; k < near.size(); ++k) {
        const bool they_want = answers.items[k] != 0;
        if (!wants && !they_want) continue;
        part.plan.partners.push_back(near[k]);
        part.plan.leaving.emplace_back();
        part.plan.images.emplace_back();
        if (!they_want) continue;
        part.plan.leaving.back() = std::move(all.leaving[k]);
        if (periods_.are_any()) part.plan.images.back() = std::move(all.images[k]);
    }
    const std::size_t n_before = discs_.size();
    part.offsets = periods_.are_any()
                       ? transfer_images(exchange_, part.plan, discs_, discs_, n_threads_)
                       : transfer(exchange_, part.plan, discs_, discs_, n_threads_);
    for (std::size_t& offset : part.offsets) offset += n_before;
    more_halo_.push_back(std::move(part));
    columns_.for_each([&](SideColumn column) { show(columns_[column]); });
    grid_.add_halo(std::span<const DiscState>(discs_).subspan(n_own_), n_threads_);
}

void StripDiscs::report_to_owners(std::span<const LocalIndex> of_halo,
                                  std::vector<LocalIndex>& reported) {
    if (has_no_halo()) return;
    report_part(halo_plan_, halo_offsets_, of_halo, reported);
    for (const HaloPart& part : more_halo_) report_part(part.plan, part.offsets, of_halo, reported);
}

/// Reports the discs of `of_halo` that lie in one part of the halo to their owners. **Collective.**
void StripDiscs::report_part(const TransferPlan& plan, std::span<const std::size_t> offsets,
                             std::span<const LocalIndex> of_halo,
                             std::vector<LocalIndex>& reported) {
    std::vector<std::vector<std::uint64_t>> out(plan.partners.size());
    for (const LocalIndex index : of_halo) {
        if (index < offsets.front() || index >= offsets.back()) continue;
        const auto behind = std::upper_bound(offsets.begin(), offsets.end(), std::size_t{index});
        const auto k = static_cast<std::size_t>(behind - offsets.begin()) - 1;
        out[k].push_back(index - offsets[k]);
    }
    Received<std::uint64_t> in;
    exchange_.exchange(std::span<const int>(plan.partners), out, in);
    for (std::size_t k = 0; k < in.n_senders(); ++k) {
        for (const std::uint64_t place : in.from(k)) reported.push_back(plan.leaving[k][place]);
    }
}

} // namespace carrom
