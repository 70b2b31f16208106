// SPDX-License-Identifier: BSD-3-Clause
// Plans which discs go to which rank, and sends them. A plan can send any array that has one
// element for each disc.
//
// Migration and the halo are two kinds of plan for the same transfer. Each rank computes its
// partners from the cuts and a bound on distances. So planning needs no messages, and each transfer
// sends one message to each partner.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/disc_state.hpp"
#include "core/image.hpp"
#include "domain/domains.hpp"
#include "parallel/neighbour_exchange.hpp"

namespace carrom {

/// The indices begin .. end - 1 of a list of discs.
struct PlaceRange {
    std::size_t begin = 0, end = 0;
};

/// The discs to be sent, with one list for each partner.
struct LeavingDiscs {
    std::vector<std::vector<LocalIndex>> leaving; ///< indices of discs, ascending
    std::vector<std::vector<Image>> images; ///< for each entry of `leaving`, the image that is
                                            ///< sent; only for halos in periodic boxes

    std::size_t n_sent() const {
        std::size_t n = 0;
        for (const std::vector<LocalIndex>& to_one : leaving) n += to_one.size();
        return n;
    }
};

struct TransferPlan : LeavingDiscs {
    std::vector<int> partners; ///< ranks; each is listed once
};

/// Lists the discs that lie in another rank's domain at `time`. The discs were in this rank's
/// domain in `before`, or at most `farthest` outside along each axis. `searched`: ascending ranges
/// that include every own disc outside of the domain.
TransferPlan plan_migration(const Domains& before, const Domains& domains, int rank,
                            std::span<const DiscState> own, std::span<const PlaceRange> searched,
                            double time, double farthest, int n_threads);

/// A halo contains the discs within `reach` of a domain along each axis, except discs within
/// `beyond`. If `beyond` is negative, no disc is left out.
struct HaloDepth {
    double reach = 0, beyond = -1;
};

/// Lists the discs for the halos of other ranks at `time`; empty domains get no discs. `searched`:
/// ascending ranges that include every own disc within reach of the domain's sides.
TransferPlan plan_halo(const Domains& domains, int rank, std::span<const DiscState> own,
                       std::span<const PlaceRange> searched, double time, const HaloDepth& depth,
                       int n_threads);

/// The same two plans for a box with periodic sides. They use positions of images; after a
/// migration the image of each own disc is in the box. A halo may also contain images of the own
/// discs of the rank, and several images of one disc.
TransferPlan plan_periodic_migration(const Domains& before, const Domains& domains, int rank,
                                     std::span<const DiscState> own, double time, double farthest,
                                     const Periods& periods, int n_threads);
/// `searched`: ascending ranges that include every own disc outside of `interior`.
TransferPlan plan_periodic_halo(const Domains& domains, int rank, std::span<const DiscState> own,
                                std::span<const PlaceRange> searched, double time,
                                const HaloDepth& depth, const Periods& periods, int n_threads);
/// The partners of both halo plans: the ranks that may exchange halo discs.
std::vector<int> halo_partners(const Domains& domains, int rank, double reach,
                               const Periods& periods);

/// The part of the rank's domain that is more than `reach` away from its sides. Sides of the box
/// count only if they are periodic.
Inside interior(const Domains& domains, int rank, double reach, const Periods& periods);

/// Sends elements of `values`, one for each own disc, according to `plan`, and appends the elements
/// that arrive to `arrived`, which may be the same array. Returns where each partner's elements
/// begin among the arrived ones, and their total number. Elements may be discs, numbers or hashes.
/// **Collective.**
template <class Values>
std::vector<std::size_t> transfer(NeighbourExchange& exchange, const TransferPlan& plan,
                                  const Values& values, Values& arrived, int n_threads);

/// Sends discs, each with the image in the plan. **Collective.**
std::vector<std::size_t> transfer_images(NeighbourExchange& exchange, const TransferPlan& plan,
                                         const DiscStates& values, DiscStates& arrived,
                                         int n_threads);

/// Appends the halo of a run with a single rank, which consists of images of its own discs.
void append_images(const TransferPlan& plan, DiscStates& values, int n_threads);

/// Removes the elements of `values` that have been sent, and fills the gaps with the last elements.
template <class Values> void remove_leaving(const TransferPlan& plan, Values& values) {
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
