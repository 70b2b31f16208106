// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/runaway.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/never.hpp"
#include "dynamics/surface_table.hpp"
#include "scene/effects/effect.hpp"

namespace carrom {

namespace {

constexpr double most_times = 0x1p17;

bool do_surfaces_slide(const Effects& effects) {
    for (std::size_t k = 0; k < SurfaceContacts::n_surfaces; ++k)
        if (does_rub(effects, k) && common_numbers(effects, k).surface.velocity != 0) return true;
    return false;
}

/// The speed of the lightest disc divided by the speed of the heaviest disc, at equal energies.
double speeds_of_equal_energy(const Effects& effects) {
    if (effects.species.empty()) return 1;
    const auto [lightest, heaviest] = std::ranges::minmax(effects.species, {}, &Species::mass);
    return std::sqrt(heaviest.mass / lightest.mass);
}

} // namespace

double runaway_speed(const SceneParameters& scene, double fastest) {
    const Effects& effects = scene.effects;
    if (!do_surfaces_slide(effects)) return never;
    double speed = std::max(usual_speed_of_effects(scene), largest_wall_speed(effects));
    for (const Boundary& side : effects.boundaries)
        speed = std::max({speed, std::fabs(side.speed), std::sqrt(side.temperature)});
    speed = std::max(fastest, speed / static_cast<double>(scene.micro_steps));
    return most_times * speeds_of_equal_energy(effects) * speed;
}

} // namespace carrom
