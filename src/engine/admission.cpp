// SPDX-License-Identifier: BSD-3-Clause
#include "engine/admission.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace carrom {

namespace {

/// The smallest gap between a disc that comes in and any other disc, relative to the sum of their
/// radii. It keeps rounding errors from making discs overlap.
constexpr double least_gap = 1e-9;

/// A disc that an arrival may let in. It comes in if its place of entry is free, even if the place
/// that it would have reached by the sync is blocked. Otherwise more fast discs would stay out.
struct Candidate {
    ReturningDisc disc; ///< the disc at the place of entry
    DiscState there;    ///< the disc at the place that it would have reached by the sync
    double radius = 0;
    bool is_blocked = false, is_blocked_there = false;
};

bool may_have(const Arrival& arrival, DiscId id) { return id >= arrival.first && id < arrival.end; }

/// The departed discs on this rank that may come in: from each arrival's range of ids those with
/// the lowest ids, at most as many as there are arrivals in total.
std::vector<ReturningDisc> lowest_of_rank(std::span<const Arrival> arrivals,
                                          const AdmissionGround& ground) {
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < arrivals.size(); ++k) {
        const Arrival& arrival = arrivals[k];
        if (k > 0 && arrival.first == arrivals[k - 1].first && arrival.end == arrivals[k - 1].end)
            continue; // this range of ids has been searched
        std::vector<std::size_t> some;
        for (std::size_t i = 0; i < ground.departed.size(); ++i)
            if (may_have(arrival, ground.departed[i].id)) some.push_back(i);
        const auto middle = some.begin() +
                            static_cast<std::ptrdiff_t>(std::min(arrivals.size(), some.size()));
        std::partial_sort(some.begin(), middle, some.end(), [&](std::size_t a, std::size_t b) {
            return ground.departed[a].id < ground.departed[b].id;
        });
        places.insert(places.end(), some.begin(), middle);
    }
    std::vector<ReturningDisc> discs;
    for (const std::size_t i : places) {
        ReturningDisc& disc = discs.emplace_back();
        disc.state = ground.departed[i];
        ground.departed_columns.for_each([&](SideColumn column) {
            disc.numbers[static_cast<std::size_t>(column)] = ground.departed_columns[column][i];
        });
    }
    return discs;
}

/// Joins the lists of all ranks, ordered by id. **Collective.**
std::map<DiscId, ReturningDisc> lowest_of_all(const std::vector<ReturningDisc>& mine,
                                              const Communicator& communicator) {
    std::map<DiscId, ReturningDisc> all;
    for (int rank = 0; rank < communicator.size(); ++rank) {
        std::vector<ReturningDisc> part;
        if (rank == communicator.rank()) part = mine;
        communicator.broadcast(part, rank);
        for (const ReturningDisc& disc : part) all.emplace(disc.state.id, disc);
    }
    return all;
}

/// Sets the disc's velocity, its place of entry and the place that it would have reached by the
/// sync. The place of entry counts as blocked if the side is too short for the disc, the other
/// place if it is less than a radius from the opposite side.
void place(Candidate& candidate, const Arrival& arrival, double mass, const Box& box) {
    const bool is_x = arrival.side < 2, is_low = arrival.side % 2 == 0;
    const double length = is_x ? box.x : box.y, width = is_x ? box.y : box.x,
                 radius = candidate.radius, root = std::sqrt(mass);
    const double inwards = arrival.inwards / root, along = arrival.along / root,
                 low = arrival.has_low_wall ? radius : -radius,
                 high = width - (arrival.has_high_wall ? radius : -radius);
    DiscState& disc = candidate.disc.state;
    (is_x ? disc.x : disc.y) = is_low ? -radius : length + radius;
    (is_x ? disc.y : disc.x) = low + (high - low) * arrival.across;
    (is_x ? disc.vx : disc.vy) = is_low ? inwards : -inwards;
    (is_x ? disc.vy : disc.vx) = along;
    disc.tau = 0;
    disc.is_departed = 0;
    disc.has_collided = 0;
    candidate.is_blocked = !(high >= low);
    candidate.there = disc;
    const double depth = inwards * arrival.flown - radius;
    (is_x ? candidate.there.x : candidate.there.y) = is_low ? depth : length - depth;
    candidate.is_blocked_there = depth > length - radius;
}

/// Marks the two places of a candidate that fixed bodies block. The path is tested as if the disc
/// came in at a right angle to the side.
void block_by_fixed_bodies(Candidate& candidate, const Arrival& arrival,
                           const AdmissionGround& ground) {
    DiscState from = candidate.disc.state, to = candidate.there;
    for (DiscState* const disc : {&from, &to}) (arrival.side < 2 ? disc->vy : disc->vx) = 0;
    if (!ground.has_room(from, from, 0)) candidate.is_blocked = true;
    if (!ground.has_room(from, to, arrival.flown)) candidate.is_blocked_there = true;
}

bool do_overlap(const DiscState& p, const DiscState& q, double radii) {
    const double dx = q.x - p.x, dy = q.y - p.y, least = radii * (1 + least_gap);
    return dx * dx + dy * dy < least * least;
}

/// Marks the places of candidates that discs of any rank block. **Collective.**
void block_by_discs(std::vector<Candidate>& candidates, const AdmissionGround& ground) {
    std::vector<std::uint64_t> n_in_way(2 * candidates.size(), 0);
    for (const DiscState& disc : ground.own)
        for (std::size_t k = 0; k < candidates.size(); ++k) {
            const Candidate& one = candidates[k];
            const DiscState &from = one.disc.state, &to = one.there;
            // Most discs are far away. They are skipped before their radii are read.
            const double far = 2 * (one.radius + ground.largest_radius);
            if (disc.x < std::min(from.x, to.x) - far || disc.x > std::max(from.x, to.x) + far ||
                disc.y < std::min(from.y, to.y) - far || disc.y > std::max(from.y, to.y) + far)
                continue;
            const double radii = one.radius + ground.species.of(disc.id).radius;
            n_in_way[2 * k] += do_overlap(disc, from, radii);
            n_in_way[2 * k + 1] += do_overlap(disc, to, radii);
        }
    ground.communicator.sum(n_in_way);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        if (n_in_way[2 * k] > 0) candidates[k].is_blocked = true;
        if (n_in_way[2 * k + 1] > 0) candidates[k].is_blocked_there = true;
    }
}

} // namespace

Admission admit(std::span<const Arrival> arrivals, const AdmissionGround& ground) {
    Admission result;
    std::map<DiscId, ReturningDisc> waiting = lowest_of_all(lowest_of_rank(arrivals, ground),
                                                            ground.communicator);
    std::vector<Candidate> candidates;
    for (const Arrival& arrival : arrivals) {
        const auto first = waiting.lower_bound(arrival.first);
        if (first == waiting.end() || first->first >= arrival.end) {
            ++result.counts.without_disc;
            continue;
        }
        const SizeAndMass& has = ground.species.of(first->first);
        Candidate& candidate = candidates.emplace_back();
        candidate.disc = first->second;
        candidate.radius = has.radius;
        waiting.erase(first);
        place(candidate, arrival, has.mass, ground.box);
        block_by_fixed_bodies(candidate, arrival, ground);
    }
    if (ground.have_pairs) block_by_discs(candidates, ground);
    std::vector<std::pair<DiscState, double>> admitted; // discs let in so far, with their radii
    for (Candidate& one : candidates) {
        const auto is_in_way_of = [&](const DiscState& state) {
            return ground.have_pairs && std::ranges::any_of(admitted, [&](const auto& other) {
                       return do_overlap(state, other.first, one.radius + other.second);
                   });
        };
        if (one.is_blocked || is_in_way_of(one.disc.state)) {
            ++result.counts.without_place;
            continue;
        }
        if (!one.is_blocked_there && !is_in_way_of(one.there)) one.disc.state = one.there;
        admitted.emplace_back(one.disc.state, one.radius);
        result.discs.push_back(one.disc);
    }
    result.counts.in = admitted.size();
    return result;
}

} // namespace carrom
