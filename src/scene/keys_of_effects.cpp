// SPDX-License-Identifier: BSD-3-Clause
// The keys of [effects] that no file of scene/effects or scene/boundaries declares.
#include "scene/boundaries/boundary.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"

namespace carrom {

namespace {

const Need lossy_pairs{"without effects.contact.kind = \"restitution\" or \"rough\"",
                       [](const Scene& s) { return are_pairs_lossy(s.effects); }};
const Need rough{"without effects.contact.kind = \"rough\"",
                 [](const Scene& s) { return s.effects.contact.kind == ContactKind::rough; }};
const Need loss_or_gravity{"without discs, walls or obstacles of restitution, a wall that "
                           "oscillates, or gravity",
                           [](const Scene& s) { return lose_energy_or_fall(s.effects); }};
constexpr Range shares{0, 1};

std::vector<Key> keys_of_contact() {
    return {
        key("effects.contact.kind", "",
            "None: discs pass through each other. Restitution: they lose energy. Rough: "
            "they turn and rub, too.",
            [](auto& s) -> auto& { return s.effects.contact.kind; })
            .advises({{"inelastic", "\"restitution\""},
                      {"granular", "\"restitution\" or \"rough\""},
                      {"hertz", "\"restitution\"; discs are hard, and contacts take no time"},
                      {"soft", "\"restitution\"; discs are hard, and contacts take no time"},
                      {"smooth", "\"elastic\" or \"restitution\""},
                      {"frictional", "\"rough\""},
                      {"ideal", "\"none\""}}),
        key("effects.contact.restitution", "1",
            "e, the share of the normal relative velocity that is left.",
            [](auto& s) -> auto& { return s.effects.contact.restitution; })
            .within(shares)
            .needs(lossy_pairs)
            .required(),
        key("effects.contact.tangential_restitution", "1",
            "Share of the sliding velocity that is reversed where surfaces stick, from -1 (smooth) "
            "to 1.",
            [](auto& s) -> auto& { return s.effects.contact.tangential_restitution; })
            .within({-1, 1})
            .needs(rough)
            .required(),
        key("effects.contact.friction", "1", "Coulomb's coefficient; surfaces slide beyond it.",
            [](auto& s) -> auto& { return s.effects.contact.friction; })
            .by_default("no limit")
            .within({0, 1e6})
            .needs(rough),
        key("effects.contact.moment_of_inertia", "m r^2",
            "Moment of inertia of a disc; a uniform one has 0.5.",
            [](auto& s) -> auto& { return s.effects.contact.inertia; })
            .within({1e-6, 1})
            .needs(rough),
        key("effects.contact.contact_time", "steps",
            "A disc that has collided this recently collides elastically. At most a "
            "quarter of the time between syncs.",
            [](auto& s) -> auto& { return s.effects.contact.contact_time; })
            .within({.low = 0, .excludes_low = true})
            .needs(loss_or_gravity),
    };
}

} // namespace

std::vector<Key> keys_of_effects() {
    std::vector<Key> all = keys_of_boundaries();
    const auto add = [&all](const std::vector<Key>& part) {
        all.insert(all.end(), part.begin(), part.end());
    };
    add(keys_of_contact());
    for (const BoundaryDeclaration& one : all_boundaries()) add(one.keys);
    for (const EffectDeclaration& one : all_effects()) add(one.keys);
    return all;
}

} // namespace carrom
