// SPDX-License-Identifier: BSD-3-Clause
// Plans which discs go to which rank, and sends them. A plan can move any array that runs along the
// discs.
//
// Halo and migration are two plans for the same move. Both ends of a plan know their partners from
// the cuts and a bound on distances alone. So the only messages are those that carry discs, one to
// each partner.
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

/// Places begin .. end - 1 of a list of discs.
struct PlaceRange {
    std::size_t begin = 0, end = 0;
};

/// The discs that leave, in one list for each partner.
struct LeavingDiscs {
    std::vector<std::vector<LocalIndex>> leaving; ///< ascending places
    std::vector<std::vector<Image>> images; ///< for each entry of `leaving` the image that is sent;
                                            ///< only for halos of periodic boxes

    std::size_t n_sent() const {
        std::size_t n = 0;
        for (const std::vector<LocalIndex>& to_one : leaving) n += to_one.size();
        return n;
    }
};

struct TransferPlan : LeavingDiscs {
    std::vector<int> partners; ///< each rank is listed once
};

/// The discs whose place at `time` lies in another rank's domain. They were in this rank's domain
/// in `before`, or at most `farthest` outside it along each axis. `searched` are ascending ranges
/// of own discs that contain all discs outside of the domain.
TransferPlan plan_migration(const Domains& before, const Domains& domains, int rank,
                            std::span<const DiscState> own, std::span<const PlaceRange> searched,
                            double time, double farthest, int n_threads);

/// A halo holds the discs within `reach` of a domain along each axis, except those within `beyond`
/// of it. A negative `beyond` excludes none.
struct HaloDepth {
    double reach = 0, beyond = -1;
};

/// The discs for the halos of other ranks at `time`. Empty domains get none. `searched` are
/// ascending ranges of own discs that contain all discs within the reach of the domain's sides.
TransferPlan plan_halo(const Domains& domains, int rank, std::span<const DiscState> own,
                       std::span<const PlaceRange> searched, double time, const HaloDepth& depth,
                       int n_threads);

/// Makes a plan from the positions of the discs' images in a box with periodic sides. After a
/// migration these are the images in the box. In a halo a disc also goes to its own rank, as other
/// images, and may go to a rank several times.
TransferPlan plan_periodic_migration(const Domains& before, const Domains& domains, int rank,
                                     std::span<const DiscState> own, double time, double farthest,
                                     const Periods& periods, int n_threads);
/// `searched` are ascending ranges of own discs that contain all discs outside of `interior`.
TransferPlan plan_periodic_halo(const Domains& domains, int rank, std::span<const DiscState> own,
                                std::span<const PlaceRange> searched, double time,
                                const HaloDepth& depth, const Periods& periods, int n_threads);
/// The partners of both plans.
std::vector<int> halo_partners(const Domains& domains, int rank, double reach,
                               const Periods& periods);

/// The part of the rank's domain that is further than `reach` from its sides. Sides of the box
/// count only if they are periodic.
Inside interior(const Domains& domains, int rank, double reach, const Periods& periods);

/// Sends those values of an array along the own discs that `plan` names, and appends the values
/// that arrive to `arrived`, which may be the same array. Returns where each partner's values begin
/// among the arrived ones, and their number at the end. The values are discs, numbers or hashes.
/// **Collective.**
template <class Values>
std::vector<std::size_t> transfer(NeighbourExchange& exchange, const TransferPlan& plan,
                                  const Values& values, Values& arrived, int n_threads);

/// Sends discs as the images that the plan names. **Collective.**
std::vector<std::size_t> transfer_images(NeighbourExchange& exchange, const TransferPlan& plan,
                                         const DiscStates& values, DiscStates& arrived,
                                         int n_threads);

/// Appends the images that a single rank sends to itself.
void append_images(const TransferPlan& plan, DiscStates& values, int n_threads);

/// Removes the discs that have left, and fills the gaps from the end.
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
