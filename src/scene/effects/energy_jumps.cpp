// SPDX-License-Identifier: BSD-3-Clause
// Checks scenes in which the mean kinetic energy changes between syncs and jumps back at syncs.
// Such scenes need frequent syncs. Samples must be spread over the time between two syncs, or some
// must be at syncs, where they are taken alternately before and after the jump.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string_view>

#include <fmt/format.h>

#include "scene/effects/effect.hpp"
#include "scene/limits.hpp"

namespace carrom {

bool does_energy_jump(const Effects& effects) {
    return std::ranges::any_of(all_effects(), [&](const EffectDeclaration& effect) {
        return effect.makes_energy_jump && effect.makes_energy_jump(effects);
    });
}

namespace {

/// The kT to which a thermostat brings a gas in the long run. For kicks it is the kT of the steady
/// state of a dilute inelastic gas, or 0 for elastic discs, which have no steady state.
double temperature_in_the_end(const SceneParameters& scene) {
    const Thermostat& t = scene.effects.thermostat;
    if (t.has_temperature()) return t.temperature;
    const double e = scene.effects.contact.restitution,
                 density = static_cast<double>(scene.n_discs) / scene.area(),
                 loss = (1 - e * e) * density * 2 * scene.radius * std::sqrt(std::numbers::pi);
    return loss > 0 ? std::pow(t.strength / loss, 2.0 / 3) : 0;
}

/// Warns of a thermostat that never acts, or acts too rarely to balance shear or lost energy.
void warn_of_rare_acts(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    if (!scene.effects.thermostat.is_on() || scene.steps == 0) return;
    const double interval = steps_between_syncs(scene);
    if (interval > static_cast<double>(scene.steps)) {
        scene.warnings.push_back(
            fmt::format("the thermostat never acts: it would every {:g} steps (time.sync_every), "
                        "and the run has {}",
                        interval, scene.steps));
        return;
    }
    constexpr double most = 4;
    const double density = static_cast<double>(scene.n_discs) / scene.area(),
                 often = 2 * std::sqrt(std::numbers::pi * temperature_in_the_end(scene)) * density *
                         2 * scene.radius; // collisions of a disc per step, in a dilute gas;
                                           // the rate is higher in a dense one
    const bool changes = scene.effects.are_sheared() || are_pairs_lossy(scene.effects);
    if (changes && often * interval > most)
        scene.warnings.push_back(fmt::format(
            "a disc collides {:.1f} times or more from one act of the thermostat to the next, so "
            "its temperature changes in between; try: time.sync_every = {:.0f}",
            often * interval, std::max(1.0, static_cast<double>(scene.micro_steps) / (2 * often))));
}

/// Warns if samples are taken at only a few different times after a sync, because their mean is not
/// the mean over time. Samples at syncs are taken alternately before and after the effects act.
void warn_of_samples_between_syncs(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    if (!scene.measurements || !does_energy_jump(scene.effects)) return;
    const MeasurementOutput& samples = *scene.measurements;
    const std::int64_t apart = std::gcd(samples.every_steps * scene.micro_steps, scene.sync_every),
                       steps = scene.sync_every / std::gcd(scene.sync_every, scene.micro_steps);
    const bool are_spread = 8 * apart <= scene.sync_every;
    if (are_spread || samples.from_step * scene.micro_steps % apart == 0) return;
    for (const char* name : {"velocities", "profiles", "diffusion", "correlations", "thermo"}) {
        if (!samples.measures(name) ||
            (name == std::string_view("thermo") && !scene.effects.are_sheared()))
            continue;
        scene.warnings.push_back(
            fmt::format("samples of \"{}\" always come at the same time between two syncs, and the "
                        "energy jumps there, so their mean energy is not that over time; let "
                        "output.measurements.every_steps and "
                        "from_step be multiples of {}",
                        name, steps));
        return;
    }
}

} // namespace

void check_energy_jumps(const SceneDraft& draft) {
    warn_of_rare_acts(draft);
    if (draft.knows_syncs()) warn_of_samples_between_syncs(draft);
}

} // namespace carrom
