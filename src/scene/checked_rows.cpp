// SPDX-License-Identifier: BSD-3-Clause
// Heaps whose rows fill the box exactly.
#include <array>
#include <cmath>

#include "scene/check.hpp"

namespace carrom {

namespace {

/// Of the box: a row with less room than this has none.
constexpr double least_room = 1e-9;

/// Discs that lose energy and come to rest on a floor between two walls. Obstacles and several
/// sizes break rows up, and a floor that moves keeps them in motion.
bool come_to_rest(const Effects& effects, std::size_t floor, std::size_t first_wall) {
    const bool lose_energy = effects.contact.kind == ContactKind::restitution ||
                             effects.contact.kind == ContactKind::rough;
    const auto is_fixed = [&](std::size_t side) {
        return effects.boundaries[side].kind == BoundaryKind::fixed;
    };
    return lose_energy && !effects.obstacles.are_any() && effects.species.empty() &&
           is_fixed(floor) && is_fixed(first_wall) && is_fixed(first_wall + 1);
}

} // namespace

/// A row without any room is pressed apart by the discs on it, and all of its discs collide with
/// both neighbours at once: thousands of collisions of a disc in a step, and a pressure far too
/// large along the row.
void check_rows(const Check& check) {
    const Scene& scene = check.scene;
    const Gravity& g = scene.effects.gravity;
    if (scene.method != Method::event_driven || (g.x != 0) == (g.y != 0)) return;
    const bool is_along_y = g.y != 0;
    const std::size_t floor = is_along_y ? (g.y < 0 ? 2 : 3) : (g.x < 0 ? 0 : 1);
    if (!come_to_rest(scene.effects, floor, is_along_y ? 0 : 2)) return;
    const double side = is_along_y ? scene.box.x : scene.box.y, diameter = 2 * scene.radius,
                 n = std::round(side / diameter);
    const bool is_full = std::fabs(side - n * diameter) <= least_room * side;
    if (!is_full || n < 2 || static_cast<double>(scene.n_discs) < n) return;
    check.refuse({"box.size"},
                 fmt::format("a row of {:g} discs at rest fills the box of {:g} from wall to wall, "
                             "without any room to move in; try: box.size = {:g}, or other radii",
                             n, side, side + 0.1 * diameter));
}

} // namespace carrom
