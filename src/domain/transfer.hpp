// SPDX-License-Identifier: BSD-3-Clause
// Who sends which discs to whom, and the sending: plan first, then move any array that goes along
// with the discs.
//
// Halo and migration are two plans for the same move. Both ends of a plan know their partners from
// the cuts and a bound on distances alone. So the only messages are those that carry discs, one to
// each partner.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/disc.hpp"
#include "core/image.hpp"
#include "domain/strips.hpp"
#include "parallel/neighbour_exchange.hpp"

namespace carrom {

/// Places begin .. end - 1 of a list of discs.
struct PlaceRange {
    std::size_t begin = 0, end = 0;
};

struct TransferPlan {
    std::vector<int> partners;                    ///< ranks, each once
    std::vector<std::vector<LocalIndex>> leaving; ///< by partner, ascending
    std::vector<std::vector<Image>>
        images; ///< along `leaving`: what goes there; of halos of periodic boxes only
};

/// Discs whose place at `time` lies in another rank's strip. They were in `old_strips`' own strip
/// at most `farthest` away. `looked_at`: places of the own discs, ascending, with all that are
/// outside of the strip.
TransferPlan plan_migration(const Strips& old_strips, const Strips& strips, int rank,
                            std::span<const Disc> own, std::span<const PlaceRange> looked_at,
                            double time, double farthest);

/// Discs that at `time` lie within `reach` of another rank's strip. Empty strips get none.
/// `looked_at`: places of the own discs, ascending, with all that are not further than `reach`
/// inside the strip.
TransferPlan plan_halo(const Strips& strips, int rank, std::span<const Disc> own,
                       std::span<const PlaceRange> looked_at, double time, double reach);

/// The same in a box with periodic sides, for the places of the discs' images; those are the ones
/// in the box. In a halo a disc goes to its own rank as well, as other images, and may go to a rank
/// several times.
TransferPlan plan_periodic_migration(const Strips& old_strips, const Strips& strips, int rank,
                                     std::span<const Disc> own, double time, double farthest,
                                     const Periods& periods);
/// `looked_at`: places of the own discs, ascending, with all that are outside of `interior`.
TransferPlan plan_periodic_halo(const Strips& strips, int rank, std::span<const Disc> own,
                                std::span<const PlaceRange> looked_at, double time, double reach,
                                const Periods& periods);

/// Places in the rank's strip that are further than `reach` from its ends, and from the box's where
/// it repeats itself along y.
Inside interior(const Strips& strips, int rank, double reach, const Periods& periods);

/// Sends what `plan` says of an array that runs along the own discs; returns what came, grouped by
/// partner.
/// **Collective.**
template <Message T>
void transfer(NeighbourExchange& exchange, const TransferPlan& plan, std::span<const T> values,
              Received<T>& in) {
    std::vector<std::vector<T>> out(plan.partners.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
        out[k].reserve(plan.leaving[k].size());
        for (const LocalIndex index : plan.leaving[k]) out[k].push_back(values[index]);
    }
    exchange.exchange(std::span<const int>(plan.partners), out, in);
}

/// The same of discs, as the images that the plan says. **Collective.**
void transfer_images(NeighbourExchange& exchange, const TransferPlan& plan,
                     std::span<const Disc> values, Received<Disc>& in);

/// What a rank that is alone sends itself: appends the images that the plan says.
void append_images(const TransferPlan& plan, std::vector<Disc>& values);

/// Takes out what has left and closes the gaps from the end.
template <class T> void remove_leaving(const TransferPlan& plan, std::vector<T>& values) {
    std::vector<LocalIndex> all;
    for (const std::vector<LocalIndex>& leaving : plan.leaving)
        all.insert(all.end(), leaving.begin(), leaving.end());
    std::sort(all.begin(), all.end());
    for (auto index = all.rbegin(); index != all.rend(); ++index) {
        values[*index] = values.back();
        values.pop_back();
    }
}

} // namespace carrom
