// SPDX-License-Identifier: BSD-3-Clause
// Discs that come to rest (dynamics/resting_dynamics.hpp).
//
// At each sync the discs that are slow, and those that rest, are gathered on every rank. Every rank
// asks statics (dynamics/heap_balance.hpp) which of them lie still until the next sync; all others
// move.
//
// The answer is a function of the places of these discs and of which of them rest. So checkpoints
// need no more than which discs rest. It is kept for as long as these stay the same: a heap at rest
// costs one comparison a sync.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "dynamics/heap_balance.hpp"
#include "dynamics/resting.hpp"
#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

/// A slow disc comes to rest if less than this share of gravity is left to it. One that rests
/// already goes on resting up to the second share; otherwise discs would wake and rest by turns.
constexpr double begins_below = 0.02, ends_above = 0.1;

class RestAtSyncs final : public SyncEffect {
public:
    explicit RestAtSyncs(const Scene& scene)
        : effects_(per_micro_step(scene.effects, static_cast<double>(scene.micro_steps))),
          interval_(static_cast<double>(scene.sync_every)),
          species_(scene.effects.species, scene.radius), places_(scene.box, effects_.gravity),
          balance_(scene.box, effects_),
          of_standing_(scene.box, effects_) {}

    void act(const SyncDiscs& at) const override {
        update_heap(at);
        for (std::size_t i = 0; i < at.discs.size(); ++i) {
            Disc& disc = at.discs[i];
            if (disc.has_departed()) continue;
            if (rests(disc.id)) {
                places_.settle(disc);
                if (!at.spins.empty()) at.spins[i] = 0;
            } else if (disc.rests()) {
                places_.wake(disc, 0);
            }
        }
        if (at.press_wall) press_walls(at);
    }

private:
    /// Brings `heap_` up to date, unless no rank has seen a change.
    void update_heap(const SyncDiscs& at) const {
        std::vector<HeapDisc> mine = slow_discs(at);
        const bool has_changed = mine != mine_;
        if (!(at.largest_over_ranks(has_changed ? 1 : 0) > 0)) return;
        mine_ = std::move(mine);
        const std::vector<std::byte> bytes = at.gather_over_ranks(std::as_bytes(std::span(mine_)));
        std::vector<HeapDisc> all(bytes.size() / sizeof(HeapDisc));
        if (!all.empty()) std::memcpy(all.data(), bytes.data(), bytes.size());
        sort_by_id(all);
        if (all == heap_) return;
        heap_ = std::move(all);
        balance_.set_discs(heap_);
        rest_ = decide();
        forces_ = {};
    }

    /// The discs of this rank that rest or are slow enough, where they would rest.
    std::vector<HeapDisc> slow_discs(const SyncDiscs& at) const {
        std::vector<HeapDisc> mine;
        const double slow = effects_.rest.speed;
        for (std::size_t i = 0; i < at.discs.size(); ++i) {
            Disc disc = at.discs[i];
            const SizeAndMass& body = species_.of(disc.id);
            const double turning = at.spins.empty() ? 0 : at.spins[i] * body.radius;
            const bool is_slow = squared_speed_of(disc) <= slow * slow &&
                                 std::fabs(turning) <= slow;
            if (disc.has_departed() || !(disc.rests() || is_slow)) continue;
            const std::uint64_t rests = disc.rests() ? 1 : 0;
            places_.settle(disc);
            mine.push_back({disc.id, disc.x, disc.y, body.radius, body.mass, rests});
        }
        sort_by_id(mine); // the order of cells changes
        return mine;
    }
    static void sort_by_id(std::vector<HeapDisc>& discs) {
        std::sort(discs.begin(), discs.end(),
                  [](const HeapDisc& a, const HeapDisc& b) { return a.id < b.id; });
    }

    /// Which discs of the heap rest from now on. Those that rest already must hold each other, which
    /// is known until one of them moves. All others must be held by these, together.
    std::vector<std::uint8_t> decide() const {
        std::vector<HeapDisc> standing;
        for (const HeapDisc& disc : heap_)
            if (disc.rests != 0) standing.push_back(disc);
        if (standing != standing_) {
            standing_ = std::move(standing);
            of_standing_.set_discs(standing_);
            left_ = of_standing_.find(std::vector<std::uint8_t>(standing_.size(), 1)).left;
        }
        std::vector<std::uint8_t> rest(heap_.size()), others(heap_.size());
        for (std::size_t i = 0, k = 0; i < heap_.size(); ++i) {
            if (heap_[i].rests != 0) rest[i] = left_[k++] < ends_above;
            others[i] = rest[i] == 0;
        }
        const HeapForces joining = balance_.find(others);
        for (std::size_t i = 0; i < heap_.size(); ++i)
            if (others[i] != 0) rest[i] = joining.left[i] < begins_below;
        return rest;
    }

    bool rests(DiscId id) const {
        const auto found = std::lower_bound(
            heap_.begin(), heap_.end(), id,
            [](const HeapDisc& disc, DiscId wanted) { return disc.id < wanted; });
        return found != heap_.end() && found->id == id &&
               rest_[static_cast<std::size_t>(found - heap_.begin())] != 0;
    }

    void press_walls(const SyncDiscs& at) const {
        if (forces_.left.empty()) forces_ = balance_.find(rest_);
        for (std::size_t side = 0; side < 4; ++side)
            at.press_wall(side, forces_.normal[side] * interval_, forces_.along[side] * interval_);
    }

    Effects effects_; ///< per micro-step
    double interval_; ///< micro-steps between syncs
    SpeciesTable species_;
    RestingPlaces places_;
    // What follows from the states of discs is kept for the next sync, so it is no state of the run.
    mutable HeapBalance balance_;
    mutable HeapBalance of_standing_;
    mutable std::vector<HeapDisc> mine_, heap_, standing_; ///< standing: that rested before a sync
    mutable std::vector<double> left_;                     ///< along `standing_`
    mutable std::vector<std::uint8_t> rest_; ///< along `heap_`
    mutable HeapForces forces_; ///< of those that rest, if they have been asked for
};

bool has_rest(const Scene& s) { return s.effects.rest.is_any(); }

const Need rests{"without effects.rest.speed", has_rest};

std::vector<Key> keys_of_rest() {
    return {
        key("effects.rest.speed", "length/step",
            "Slower discs come to rest where others, walls or obstacles hold them.",
            [](auto& s) -> auto& { return s.effects.rest.speed; })
            .within({.low = 0}),
        key("effects.rest.gap", "length", "Discs as close as this hold each other.",
            [](auto& s) -> auto& { return s.effects.rest.gap; })
            .by_default("a fiftieth of the radius")
            .within({.low = 0, .excludes_low = true})
            .needs(rests),
        key("effects.rest.wake_speed", "length/step",
            "A disc that rests moves again when another one hits it faster than this.",
            [](auto& s) -> auto& { return s.effects.rest.wake; })
            .by_default("twice effects.rest.speed")
            .within({.low = 0})
            .needs(rests),
    };
}

std::vector<Rule> rules_of_rest() {
    const RuleKeys keys = {"effects.rest.speed"};
    return {
        rule("discs that come to rest", "no gravity",
             "nothing holds discs on each other; set effects.gravity", keys,
             [](const Scene& s) { return has_rest(s) && !s.effects.gravity.is_any(); }),
        rule("discs that come to rest", "elastic discs, or discs that pass through each other",
             "these never come to rest; take effects.contact.kind = \"restitution\" or \"rough\"",
             keys,
             [](const Scene& s) {
                 const ContactKind kind = s.effects.contact.kind;
                 return has_rest(s) &&
                        (kind == ContactKind::elastic || kind == ContactKind::none);
             }),
        rule("discs that come to rest", "drag or a thermostat", "this version does not have both",
             keys,
             [](const Scene& s) {
                 return has_rest(s) && (s.effects.drag != 0 || s.effects.thermostat.is_any());
             }),
        rule("discs that come to rest", "a moving, an oscillating, a periodic or a sheared side",
             "this version does not have both", keys,
             [](const Scene& s) {
                 return has_rest(s) &&
                        (has_moving(s) || has_oscillating(s) || s.effects.are_periodic());
             }),
    };
}

double smallest_radius_of(const Scene& scene) {
    double smallest = scene.radius;
    for (const Species& one : scene.effects.species) smallest = std::min(smallest, one.radius);
    return smallest;
}

void derive_rest(const SceneDraft& draft) {
    Rest& rest = draft.scene.effects.rest;
    if (!rest.is_any()) return;
    if (!draft.settings.has("effects.rest.wake_speed")) rest.wake = 2 * rest.speed;
}

/// A disc that has lost its hold waits for the next sync before it falls.
void check_wait(const SceneDraft& draft) {
    const Scene& scene = draft.scene;
    const Gravity& g = scene.effects.gravity;
    const double radius = smallest_radius_of(scene), pull = std::hypot(g.x, g.y);
    const double longest = std::sqrt(2 * radius / pull);
    if (!(steps_between_syncs(scene) > longest)) return;
    const double most = std::floor(longest * static_cast<double>(scene.micro_steps));
    draft.refuse({"time.sync_every", "effects.rest.speed"},
                 fmt::format("discs that lose their hold wait for a sync, in {:g} steps at most, in "
                             "which they would fall further than a radius; {}",
                             steps_between_syncs(scene),
                             most >= 1 ? fmt::format("time.sync_every = {} or less will do", most)
                                       : "take more time.micro_steps"));
}

void check_room_of_rest(const SceneDraft& draft) {
    Rest& rest = draft.scene.effects.rest;
    if (!rest.is_any()) return;
    const double radius = smallest_radius_of(draft.scene); // radii are known only now
    if (!draft.settings.has("effects.rest.gap")) rest.gap = radius / 50;
    if (rest.gap > radius / 4)
        draft.refuse({"effects.rest.gap"},
                     fmt::format("'effects.rest.gap' = {} is more than a quarter of the smallest "
                                 "radius: {:g} at most",
                                 rest.gap, radius / 4));
    if (radius > 0 && draft.scene.effects.gravity.is_any()) check_wait(draft);
}

} // namespace

namespace effects {

EffectDeclaration rest() {
    return {.tables = {{"effects.rest", "Discs that lie still until something moves them."}},
            .keys = keys_of_rest(),
            .rules = rules_of_rest(),
            .derive = derive_rest,
            .check_room = check_room_of_rest,
            .summary =
                [](const Effects& e) {
                    return e.rest.is_any()
                               ? fmt::format("discs slower than {:g} come to rest", e.rest.speed)
                               : "";
                },
            .allowance =
                [](const Effects& e) {
                    return CheckAllowance{.collisions_take_energy = e.rest.is_any(),
                                          .acts_at_syncs = e.rest.is_any()};
                },
            .at_syncs = [](const Scene& s) -> std::unique_ptr<SyncEffect> {
                if (!has_rest(s)) return nullptr;
                return std::make_unique<RestAtSyncs>(s);
            }};
}

} // namespace effects

} // namespace carrom
