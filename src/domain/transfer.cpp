// SPDX-License-Identifier: BSD-3-Clause
#include "domain/transfer.hpp"

#include <algorithm>

#include "core/errors.hpp"

namespace carrom {

namespace {

/// Finds a partner's place in the plan; a plan has few.
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
                            double time, double farthest) {
    TransferPlan plan;
    plan.partners = movers_between(before, domains, rank, farthest);
    plan.leaving.resize(plan.partners.size());
    if (domains.size() == 1) return plan;
    const PartnerPlaces places(plan.partners);
    const Domain mine = domains.of(rank);
    for (const PlaceRange range : searched) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const auto [along, across] = domains.place_of(own[i], time);
            if (mine.holds(along, across)) continue;
            const int owner = domains.owner(along, across);
            if (owner != rank) plan.leaving[places[owner]].push_back(static_cast<LocalIndex>(i));
        }
    }
    return plan;
}

TransferPlan plan_halo(const Domains& domains, int rank, std::span<const DiscState> own,
                       std::span<const PlaceRange> searched, double time, const HaloDepth& depth) {
    TransferPlan plan;
    plan.partners = domains.neighbours_within(rank, depth.reach);
    plan.leaving.resize(plan.partners.size());
    for (std::size_t k = 0; k < plan.partners.size(); ++k) {
        const Domain theirs = domains.of(plan.partners[k]);
        for (const PlaceRange range : searched) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const auto [along, across] = domains.place_of(own[i], time);
                if (theirs.is_within(depth.reach, along, across) &&
                    (depth.beyond < 0 || !theirs.is_within(depth.beyond, along, across)))
                    plan.leaving[k].push_back(static_cast<LocalIndex>(i));
            }
        }
    }
    return plan;
}

} // namespace carrom
