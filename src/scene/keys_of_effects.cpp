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
const Need loss_or_gravity{"without discs, walls or obstacles of restitution, or gravity",
                           [](const Scene& s) { return lose_energy_or_fall(s.effects); }};
const Need obstacles{"without 'effects.obstacles.discs' or 'effects.obstacles.segments'",
                     [](const Scene& s) { return s.effects.obstacles.are_any(); }};
const Need thermal{"without a side of kind = \"thermal\"",
                   [](const Scene& s) { return has_boundary(s.effects, BoundaryKind::thermal); }};

constexpr Range shares{0, 1};

Need side_needs(std::size_t side, BoundaryKind kind, const char* word) {
    return {"without box." + std::string(boundary_names[side]) + ".kind = \"" + word + '"',
            [side, kind](const Scene& s) { return s.effects.boundaries[side].kind == kind; }};
}

Need reflecting(std::size_t side) {
    return {"without box." + std::string(boundary_names[side]) + ".kind = \"wall\" or \"moving\"",
            [side](const Scene& s) {
                const BoundaryKind kind = s.effects.boundaries[side].kind;
                return kind == BoundaryKind::fixed || kind == BoundaryKind::moving;
            }};
}

/// Low walls may move in only: outwards they would leave the box, which begins at 0.
Range wall_speeds(std::size_t side) {
    if (side % 2 == 1) return {};
    return {.low = 0, .why = "the wall would leave the box; let the opposite one move out"};
}

void add_side(std::vector<Key>& all, std::size_t side) {
    const std::string table = std::string("box.") + boundary_names[side];
    all.push_back(key(
        {.name = table + ".kind",
         .help = "Wall; thermal: discs leave as if from a gas; moving: a piston; open: discs leave "
                 "the box; periodic, in pairs."},
        [side](auto& s) -> auto& { return s.effects.boundaries[side].kind; }));
    all.push_back(key({.name = table + ".restitution",
                       .unit = "1",
                       .help = "Share of the normal velocity that is left after a collision.",
                       .range = shares,
                       .need = reflecting(side)},
                      [side](auto& s) -> auto& { return s.effects.boundaries[side].restitution; }));
    all.push_back(key({.name = table + ".temperature",
                       .unit = "length^2/step^2",
                       .help = "kT of a thermal wall, for discs of mass 1.",
                       .range = {1e-60, 1e60},
                       .need = side_needs(side, BoundaryKind::thermal, "thermal"),
                       .is_required = true},
                      [side](auto& s) -> auto& { return s.effects.boundaries[side].temperature; }));
    all.push_back(key({.name = table + ".speed",
                       .unit = "length/step",
                       .help = "Speed of a moving wall along +x or +y.",
                       .range = wall_speeds(side),
                       .need = side_needs(side, BoundaryKind::moving, "moving"),
                       .is_required = true},
                      [side](auto& s) -> auto& { return s.effects.boundaries[side].speed; }));
}

std::vector<Key> keys_of_contact() {
    return {
        key({.name = "effects.contact.kind",
             .help = "None: discs pass through each other. Restitution: they lose energy. Rough: "
                     "they turn and rub, too."},
            [](auto& s) -> auto& { return s.effects.contact.kind; }),
        key({.name = "effects.contact.restitution",
             .unit = "1",
             .help = "e, the share of the normal relative velocity that is left.",
             .range = shares,
             .need = lossy_pairs,
             .is_required = true},
            [](auto& s) -> auto& { return s.effects.contact.restitution; }),
        key({.name = "effects.contact.tangential_restitution",
             .unit = "1",
             .help = "Of surfaces that stick, from -1 (smooth) to 1 (perfectly rough).",
             .range = {-1, 1},
             .need = rough,
             .is_required = true},
            [](auto& s) -> auto& { return s.effects.contact.tangential_restitution; }),
        key({.name = "effects.contact.friction",
             .unit = "1",
             .help = "Coulomb's coefficient; surfaces slide beyond it.",
             .fallback = "no limit",
             .range = {0, 1e6},
             .need = rough},
            [](auto& s) -> auto& { return s.effects.contact.friction; }),
        key({.name = "effects.contact.moment_of_inertia",
             .unit = "m r^2",
             .help = "Of a disc; 0.5 is a uniform one's.",
             .range = {1e-6, 1},
             .need = rough},
            [](auto& s) -> auto& { return s.effects.contact.inertia; }),
        key({.name = "effects.contact.contact_time",
             .unit = "steps",
             .help = "A disc that has collided this recently collides elastically. At most a "
                     "quarter of the time between syncs.",
             .range = {.low = 0, .excludes_low = true},
             .need = loss_or_gravity},
            [](auto& s) -> auto& { return s.effects.contact.contact_time; }),
    };
}

} // namespace

std::vector<Key> keys_of_effects() {
    std::vector<Key> all;
    for (std::size_t side = 0; side < boundary_names.size(); ++side) add_side(all, side);
    for (Key& one : keys_of_contact()) all.push_back(std::move(one));
    std::vector<Key> others = {
        key({.name = "effects.gravity.x", .unit = "length/step^2", .help = "Acceleration along x."},
            [](auto& s) -> auto& { return s.effects.gravity.x; }),
        key({.name = "effects.gravity.y", .unit = "length/step^2", .help = "Acceleration along y."},
            [](auto& s) -> auto& { return s.effects.gravity.y; }),
        key({.name = "effects.drag.rate",
             .unit = "1/step",
             .help = "c of dv/dt = -c v, for all discs alike. At most 4 per time between syncs.",
             .range = {.low = 0}},
            [](auto& s) -> auto& { return s.effects.drag; }),
        key({.name = "effects.thermal.seed",
             .unit = "1",
             .help = "Seed of the random numbers of thermal walls.",
             .range = {.low = 0},
             .need = thermal},
            [](auto& s) -> auto& { return s.effects.thermal_seed; }),
        key({.name = "effects.obstacles.discs",
             .unit = "length",
             .help = "Fixed discs; a radius of 0 is a point.",
             .fields = {{"", "[x, y, radius]", 3, 3}}},
            [](auto& s) -> auto& { return s.effects.obstacles.discs; }),
        key({.name = "effects.obstacles.segments",
             .unit = "length",
             .help = "Straight walls without thickness; discs meet both faces and both ends.",
             .fields = {{"", "[x0, y0, x1, y1]", 4, 4}}},
            [](auto& s) -> auto& { return s.effects.obstacles.segments; }),
        key({.name = "effects.obstacles.restitution",
             .unit = "1",
             .help = "Share of the normal velocity that is left, of all obstacles.",
             .range = shares,
             .need = obstacles},
            [](auto& s) -> auto& { return s.effects.obstacles.restitution; }),
    };
    for (Key& one : others) all.push_back(std::move(one));
    return all;
}

} // namespace carrom
