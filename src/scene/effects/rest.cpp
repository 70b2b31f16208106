// SPDX-License-Identifier: BSD-3-Clause
// Discs that come to rest (dynamics/resting_dynamics.hpp).
//
// At each sync all discs that are slow, and those that rest, are gathered on every rank. Every rank
// finds which of them hold each other (dynamics/heap_balance.hpp). These rest until the next sync,
// or until a hit wakes them; all others move. The answer is a function of the places of these discs
// alone, so nothing is stored but which discs rest, and ranks need not agree on anything. It is
// kept for as long as the places stay the same, so a heap at rest costs one comparison a sync.
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

class RestAtSyncs final : public SyncEffect {
public:
    explicit RestAtSyncs(const Scene& scene)
        : effects_(per_micro_step(scene.effects, static_cast<double>(scene.micro_steps))),
          interval_(static_cast<double>(scene.sync_every)),
          species_(scene.effects.species, scene.radius), places_(scene.box, effects_.gravity),
          balance_(scene.box, effects_) {}

    void act(const SyncDiscs& at) const override {
        std::vector<HeapDisc> heap = slow_discs(at);
        if (heap != heap_) {
            heap_ = std::move(heap);
            forces_ = balance_.find(heap_);
        }
        for (std::size_t i = 0; i < at.discs.size(); ++i) {
            Disc& disc = at.discs[i];
            const bool rests = !disc.has_departed() && is_held(disc.id);
            if (rests) {
                places_.settle(disc);
                if (!at.spins.empty()) at.spins[i] = 0;
            } else if (disc.rests()) {
                places_.wake(disc, 0);
            }
        }
        if (!at.press_wall) return;
        for (std::size_t side = 0; side < 4; ++side)
            at.press_wall(side, forces_.on_walls[side] * interval_);
    }

private:
    /// The discs of all ranks that rest or are slow enough, in the order of ids, where they would
    /// rest.
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
            places_.settle(disc);
            mine.push_back({disc.id, disc.x, disc.y, body.radius, body.mass});
        }
        const std::vector<std::byte> bytes = at.gather_over_ranks(std::as_bytes(std::span(mine)));
        std::vector<HeapDisc> all(bytes.size() / sizeof(HeapDisc));
        if (!all.empty()) std::memcpy(all.data(), bytes.data(), bytes.size());
        std::sort(all.begin(), all.end(),
                  [](const HeapDisc& a, const HeapDisc& b) { return a.id < b.id; });
        return all;
    }

    bool is_held(DiscId id) const {
        const auto found = std::lower_bound(
            heap_.begin(), heap_.end(), id,
            [](const HeapDisc& disc, DiscId wanted) { return disc.id < wanted; });
        return found != heap_.end() && found->id == id &&
               forces_.is_held[static_cast<std::size_t>(found - heap_.begin())] != 0;
    }

    Effects effects_; ///< per micro-step
    double interval_; ///< micro-steps between syncs
    SpeciesTable species_;
    RestingPlaces places_;
    HeapBalance balance_;
    // The last answer. It follows from the list, so it is no state of the run.
    mutable std::vector<HeapDisc> heap_;
    mutable HeapForces forces_;
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

void derive_rest(const Check& check) {
    Rest& rest = check.scene.effects.rest;
    if (!rest.is_any()) return;
    if (!check.settings.has("effects.rest.wake_speed")) rest.wake = 2 * rest.speed;
}

void check_room_of_rest(const Check& check) {
    Rest& rest = check.scene.effects.rest;
    if (rest.is_any() && !check.settings.has("effects.rest.gap")) // radii are known only now
        rest.gap = smallest_radius_of(check.scene) / 50;
    const double widest = smallest_radius_of(check.scene) / 4;
    if (rest.is_any() && rest.gap > widest)
        check.refuse({"effects.rest.gap"},
                     fmt::format("'effects.rest.gap' = {} is more than a quarter of the smallest "
                                 "radius: {:g} at most",
                                 rest.gap, widest));
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
