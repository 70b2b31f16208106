// SPDX-License-Identifier: BSD-3-Clause
// The keys of the box's sides and of [effects].
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
const Need thermal{"without a side of kind = \"thermal\"",
                   [](const Scene& s) { return has_boundary(s.effects, BoundaryKind::thermal); }};

constexpr Range shares{0, 1};

Need side_needs(std::size_t side, BoundaryKind kind, const char* word) {
    return {"without box." + std::string(boundary_names[side]) + ".kind = \"" + word + '"',
            [side, kind](const Scene& s) { return s.effects.boundaries[side].kind == kind; }};
}

Need reflecting(std::size_t side) {
    return {"without box." + std::string(boundary_names[side]) +
                ".kind = \"wall\", \"moving\" or \"oscillating\"",
            [side](const Scene& s) {
                const BoundaryKind kind = s.effects.boundaries[side].kind;
                return kind == BoundaryKind::fixed || kind == BoundaryKind::moving ||
                       kind == BoundaryKind::oscillating;
            }};
}

/// Low walls may move in only: outwards they would leave the box, which begins at 0.
Range wall_speeds(std::size_t side) {
    if (side % 2 == 1) return {};
    return {.low = 0, .why = "the wall would leave the box; let the opposite one move out"};
}

void add_side(std::vector<Key>& all, std::size_t side) {
    const std::string table = std::string("box.") + boundary_names[side];
    all.push_back(
        key(table + ".kind", "",
            "Wall; thermal: discs leave as if from a gas; moving: a piston; oscillating: a shaker; "
            "open: discs leave the box; periodic, in pairs; sheared: bottom and top, periodic with "
            "images that move.",
            [side](auto& s) -> auto& { return s.effects.boundaries[side].kind; }));
    all.push_back(key(table + ".restitution", "1",
                      "Share of the normal velocity that is left after a collision.",
                      [side](auto& s) -> auto& { return s.effects.boundaries[side].restitution; })
                      .within(shares)
                      .needs(reflecting(side)));
    all.push_back(key(table + ".temperature", "length^2/step^2",
                      "kT of a thermal wall, for discs of mass 1.",
                      [side](auto& s) -> auto& { return s.effects.boundaries[side].temperature; })
                      .within({1e-60, 1e60})
                      .needs(side_needs(side, BoundaryKind::thermal, "thermal"))
                      .required());
    all.push_back(key(table + ".speed", "length/step", "Speed of a moving wall along +x or +y.",
                      [side](auto& s) -> auto& { return s.effects.boundaries[side].speed; })
                      .within(wall_speeds(side))
                      .needs(side_needs(side, BoundaryKind::moving, "moving"))
                      .required());
    const Need oscillating = side_needs(side, BoundaryKind::oscillating, "oscillating");
    all.push_back(
        key(table + ".amplitude", "length",
            "A: the wall is A sin(2 pi t / period + phase) from its line, along +x or +y.",
            [side](auto& s) -> auto& { return s.effects.boundaries[side].amplitude; })
            .within({.low = 0})
            .needs(oscillating)
            .required());
    all.push_back(key(table + ".period", "steps", "Of an oscillating wall.",
                      [side](auto& s) -> auto& { return s.effects.boundaries[side].period; })
                      .within({.low = 0, .excludes_low = true})
                      .needs(oscillating)
                      .required());
    all.push_back(key(table + ".phase", "radians", "Of an oscillating wall, at step 0.",
                      [side](auto& s) -> auto& { return s.effects.boundaries[side].phase; })
                      .within({-100, 100})
                      .needs(oscillating));
}

std::vector<Key> keys_of_contact() {
    return {
        key("effects.contact.kind", "",
            "None: discs pass through each other. Restitution: they lose energy. Rough: "
            "they turn and rub, too.",
            [](auto& s) -> auto& { return s.effects.contact.kind; })
            .advises({{"inelastic", "\"restitution\""},
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
            "Of surfaces that stick, from -1 (smooth) to 1 (perfectly rough).",
            [](auto& s) -> auto& { return s.effects.contact.tangential_restitution; })
            .within({-1, 1})
            .needs(rough)
            .required(),
        key("effects.contact.friction", "1", "Coulomb's coefficient; surfaces slide beyond it.",
            [](auto& s) -> auto& { return s.effects.contact.friction; })
            .by_default("no limit")
            .within({0, 1e6})
            .needs(rough),
        key("effects.contact.moment_of_inertia", "m r^2", "Of a disc; 0.5 is a uniform one's.",
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
    std::vector<Key> all;
    for (std::size_t side = 0; side < boundary_names.size(); ++side) add_side(all, side);
    for (Key& one : keys_of_contact()) all.push_back(std::move(one));
    std::vector<Key> others = {
        key("effects.thermal.seed", "1", "Seed of the random numbers of thermal walls.",
            [](auto& s) -> auto& { return s.effects.thermal_seed; })
            .within({.low = 0})
            .needs(thermal)
            .seed(),
    };
    for (Key& one : others) all.push_back(std::move(one));
    return all;
}

} // namespace carrom
