// SPDX-License-Identifier: BSD-3-Clause
#include "troubled_effects.hpp"
#include "scene/effects/effect.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamics/drag.hpp"
#include "dynamics/falling_contact.hpp"
#include "dynamics/falling_frame.hpp"
#include "scene_tools.hpp"

namespace carrom::test {

namespace {

ContactEffect troubled_contact(Random& random) {
    switch (random.index(4)) {
    case 0: return {ContactKind::none, 1, 0.001};
    case 1:
        return {ContactKind::restitution, std::array{0.0, 0.5, 0.9, 1 - 0x1p-53}[random.index(4)],
                0.001};
    default: return {};
    }
}

/// A random wall; `may_move` if the method allows moving walls.
Boundary troubled_wall(std::size_t number, bool may_move, Random& random) {
    const double inwards = number % 2 == 0 ? 1 : -1;
    switch (random.index(5)) {
    case 0: return {BoundaryKind::wall, std::array{0.0, 0.5, 0.9}[random.index(3)], 0, 0};
    case 1: return {BoundaryKind::thermal, 1, 0.25, 0};
    case 2:
        if (may_move)
            return {BoundaryKind::moving, std::array{1.0, 0.5}[random.index(2)], 0,
                    inwards * std::array{-0.25, -0.01, 0.01}[random.index(3)]};
        break;
    default: break;
    }
    return {};
}

} // namespace

void hand_to_reference(reference::Setting& setting) {
    set_thermal_seed(setting, setting.effects.thermal_seed);
    set_oscillation(setting);
    setting.falling_contact = falling_contact;
    const double c = setting.effects.drag / static_cast<double>(setting.micro_steps);
    setting.drag_clock = {};
    if (!(c > 0)) return;
    setting.drag_clock = [c](double n) { return drag_clock(c, n); };
    setting.dragged_fall = [c](double clock) { return dragged_fall(c, clock); };
    setting.dragged_fall_delay = [c](double distance, double velocity, double pull) {
        return dragged_fall_delay(distance, velocity, pull, c);
    };
}

TestScene with_effects(TestScene scene, Method method, std::uint64_t seed) {
    Random random(seed ^ 0x9e3779b97f4a7c15u);
    reference::Setting& setting = scene.setting;
    Effects& effects = setting.effects;
    const bool is_all = method == Method::event_driven;
    const double interval = static_cast<double>(setting.sync_every) /
                            static_cast<double>(setting.micro_steps);
    effects.contact = troubled_contact(random);
    effects.contact.contact_time = std::min(effects.contact.contact_time, interval / 4);
    const bool has_drag = is_all && random.index(4) == 0;
    for (const std::size_t low : {0u, 2u}) {
        if (!has_drag && random.index(3) == 0) {
            effects.boundaries[low] = effects.boundaries[low + 1] = {BoundaryKind::periodic, 1, 0,
                                                                     0};
            continue;
        }
        for (const std::size_t number : {low, low + 1})
            effects.boundaries[number] = troubled_wall(number, is_all, random);
    }
    if (has_drag) effects.drag = std::min(0.2, 1 / interval);
    // Limits gravity, because a frame that falls by half the box between syncs is an error.
    const double most = 0.2 * setting.box_size / (interval * interval);
    const std::array<double, 2> pull{std::min(0.05, most), -std::min(0.02, most)};
    if (is_all && random.index(2) == 0) {
        if (!effects.is_periodic_x()) effects.gravity.x = pull[random.index(2)];
        if (!effects.is_periodic_y()) effects.gravity.y = pull[random.index(2)];
    }
    hand_to_reference(setting);
    scene.name += ", with " + (summary_of(effects).empty() ? "no effect" : summary_of(effects));
    return scene;
}

} // namespace carrom::test
