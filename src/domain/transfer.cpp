// SPDX-License-Identifier: BSD-3-Clause
#include "domain/transfer.hpp"

#include <algorithm>

#include "core/errors.hpp"
#include "domain/transfer_in_parts.hpp"

namespace carrom {

namespace {

/// Finds the index of a partner in the plan's list by its rank, in constant time.
class PartnerPlaces {
public:
    explicit PartnerPlaces(const std::vector<int>& partners) {
        for (std::size_t k = 0; k < partners.size(); ++k) {
            const auto rank = static_cast<std::size_t>(partners[k]);
            if (places_.size() <= rank) places_.resize(rank + 1, none);
            places_[rank] = k;
        }
    }
    std::size_t operator[](int rank) const {
        const auto r = static_cast<std::size_t>(rank);
        ensure(r < places_.size() && places_[r] != none,
               "a disc goes to a rank that does not expect it");
        return places_[r];
    }

private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::vector<std::size_t> places_;
};

} // namespace

TransferPlan plan_migration(const Domains& before, const Domains& domains, int rank,
                            std::span<const DiscState> own, std::span<const PlaceRange> searched,
                            double time, double farthest, int n_threads) {
    TransferPlan plan;
    plan.partners = movers_between(before, domains, rank, farthest);
    plan.leaving.resize(plan.partners.size());
    if (domains.size() == 1) return plan;
    const PartnerPlaces places(plan.partners);
    const Domain mine = domains.of(rank);
    plan_in_parts(plan, searched, n_threads, [&](LocalIndex i, LeavingDiscs& part) {
        const auto [along, across] = domains.place_of(own[i], time);
        if (mine.holds(along, across)) return;
        const int owner = domains.owner(along, across);
        if (owner != rank) part.leaving[places[owner]].push_back(i);
    });
    return plan;
}

TransferPlan plan_halo(const Domains& domains, int rank, std::span<const DiscState> own,
                       std::span<const PlaceRange> searched, double time, const HaloDepth& depth,
                       int n_threads) {
    TransferPlan plan;
    plan.partners = domains.neighbours_within(rank, depth.reach);
    plan.leaving.resize(plan.partners.size());
    std::vector<Domain> theirs;
    for (const int partner : plan.partners) theirs.push_back(domains.of(partner));
    plan_in_parts(plan, searched, n_threads, [&](LocalIndex i, LeavingDiscs& part) {
        const auto [along, across] = domains.place_of(own[i], time);
        for (std::size_t k = 0; k < theirs.size(); ++k)
            if (theirs[k].is_within(depth.reach, along, across) &&
                (depth.beyond < 0 || !theirs[k].is_within(depth.beyond, along, across)))
                part.leaving[k].push_back(i);
    });
    return plan;
}

template <class Values>
std::vector<std::size_t> transfer(NeighbourExchange& exchange, const TransferPlan& plan,
                                  const Values& values, Values& arrived, int n_threads) {
    return transfer_packed(
        exchange, plan, values, arrived, n_threads,
        [](const typename Values::value_type& value, std::size_t, std::size_t) { return value; });
}

#define CARROM_DEFINE(Values)                                                                      \
    template std::vector<std::size_t> transfer(NeighbourExchange&, const TransferPlan&,            \
                                               const Values&, Values&, int);
CARROM_DEFINE(DiscStates)
CARROM_DEFINE(std::vector<double>)
CARROM_DEFINE(RawVector<std::uint64_t>)
#undef CARROM_DEFINE

} // namespace carrom
