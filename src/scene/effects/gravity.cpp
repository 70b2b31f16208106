// SPDX-License-Identifier: BSD-3-Clause
// Uniform gravity (dynamics/falling_frame.hpp), which may change in time (dynamics/sway.hpp).
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "dynamics/drag.hpp"
#include "dynamics/falling_frame.hpp"
#include "dynamics/surface_table.hpp"
#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

/// The least period of gravity that changes, in units of the time between syncs.
constexpr double least_syncs = 8;

const Need swaying{"without 'effects.gravity.amplitude_x' or 'effects.gravity.amplitude_y'",
                   [](const SceneParameters& s) { return s.effects.gravity.sways(); }};

std::vector<Key> keys_of_gravity() {
    return {
        key("effects.gravity.x", "length/step^2", "Acceleration along x.",
            [](auto& s) -> auto& { return s.effects.gravity.x; }),
        key("effects.gravity.y", "length/step^2", "Acceleration along y.",
            [](auto& s) -> auto& { return s.effects.gravity.y; }),
        key("effects.gravity.amplitude_x", "length/step^2",
            "A: beside its steady part gravity has A sin(2 pi t / period + phase_x) along x.",
            [](auto& s) -> auto& { return s.effects.gravity.amplitude_x; }),
        key("effects.gravity.amplitude_y", "length/step^2",
            "The same along y. With equal amplitudes, and phase_x a quarter turn (1.5708) above "
            "phase_y, it turns counterclockwise.",
            [](auto& s) -> auto& { return s.effects.gravity.amplitude_y; }),
        key("effects.gravity.period", "steps",
            "Period of the part that changes; eight times between syncs at least.",
            [](auto& s) -> auto& { return s.effects.gravity.period; })
            .within({.low = 0, .excludes_low = true})
            .needs(swaying)
            .required(),
        key("effects.gravity.phase_x", "radians", "Its phase along x at step 0.",
            [](auto& s) -> auto& { return s.effects.gravity.phase_x; })
            .within({-100, 100})
            .needs(swaying),
        key("effects.gravity.phase_y", "radians", "Its phase along y at step 0.",
            [](auto& s) -> auto& { return s.effects.gravity.phase_y; })
            .within({-100, 100})
            .needs(swaying),
    };
}

/// Whether contacts with a surface take energy from the discs of at least one species.
bool does_take_energy(const Effects& e, std::size_t surface) {
    const auto takes = [](const SurfaceNumbers& numbers) {
        return numbers.is_lossy() || std::fabs(numbers.surface.tangential_restitution) < 1;
    };
    return takes(common_numbers(e, surface)) ||
           std::ranges::any_of(e.surface_contacts.rows[surface], [&](const SurfaceContact& row) {
               return takes(numbers_of(e, surface, row));
           });
}

/// Whether discs that gravity drives along the sides `low` and `low + 1` reach a steady flow. For
/// this, something must take their momentum along these sides, and something must take energy.
/// Obstacles take momentum, because discs collide with them.
bool are_stopped(const SceneParameters& s, std::size_t low) {
    const Effects& e = s.effects;
    const ThermostatKind kind = e.thermostat.kind;
    if (e.drag != 0 || e.thermostat.is_bath()) return true;
    const auto any = [&](const auto& what) { return what(low) || what(low + 1); };
    const bool are_thermal = any(
        [&](std::size_t side) { return e.boundaries[side].kind == BoundaryKind::thermal; });
    const auto takes_energy = [&](std::size_t surface) { return does_take_energy(e, surface); };
    const bool is_energy_taken = are_pairs_lossy(e) || kind == ThermostatKind::rescale ||
                                 any(takes_energy) ||
                                 (has_fixed_bodies(s) &&
                                  takes_energy(SurfaceContacts::fixed_bodies));
    const bool is_momentum_taken = has_fixed_bodies(s) ||
                                   any([&](std::size_t side) { return does_rub(e, side); });
    return are_thermal || (is_energy_taken && is_momentum_taken);
}

std::vector<Rule> rules_of_gravity() {
    constexpr std::string_view why =
        "discs would fall for ever; take drag, a thermostat of kind \"langevin\", thermal sides, "
        "sides with a tangential_restitution above -1, or obstacles with a restitution below 1";
    return {
        rule("gravity", "time.method = \"time-stepped\"",
             "discs fly straight there; take time.method = \"event-driven\"",
             {"effects.gravity.y", "effects.gravity.x"},
             [](const SceneParameters& s) {
                 return s.effects.gravity.is_on() && is_time_stepped(s);
             }),
        rule("gravity along x", "periodic sides left and right where nothing stops discs", why,
             {"effects.gravity.x"},
             [](const SceneParameters& s) {
                 return s.effects.gravity.x != 0 && s.effects.is_periodic_x() &&
                        !s.effects.are_sheared() && !are_stopped(s, 2);
             }),
        rule("gravity along y", "periodic sides bottom and top where nothing stops discs", why,
             {"effects.gravity.y"},
             [](const SceneParameters& s) {
                 return s.effects.gravity.y != 0 && s.effects.is_periodic_y() &&
                        !s.effects.are_sheared() && !are_stopped(s, 0);
             }),
        rule("gravity that changes", "drag",
             "contacts with walls are found on parabolas and one sine",
             {"effects.gravity.amplitude_x", "effects.gravity.amplitude_y"},
             [](const SceneParameters& s) {
                 return s.effects.gravity.sways() && s.effects.drag != 0;
             }),
        rule("gravity that changes", "obstacles",
             "contacts with bodies are found on straight lines and parabolas",
             {"effects.gravity.amplitude_x", "effects.gravity.amplitude_y"},
             [](const SceneParameters& s) {
                 return s.effects.gravity.sways() && has_fixed_bodies(s);
             }),
        rule("gravity that changes", "contacts that last",
             "these are pressed by one force from sync to sync", {"effects.lasting_contacts.speed"},
             [](const SceneParameters& s) {
                 return s.effects.gravity.sways() && s.effects.lasting_speed > 0;
             }),
        rule("gravity along periodic sides", "sheared sides",
             "nothing stops discs in a flow without walls",
             {"effects.gravity.x", "effects.gravity.y"},
             [](const SceneParameters& s) {
                 return s.effects.are_sheared() && s.effects.gravity.is_on();
             }),
    };
}

/// A disc's potential energy. Heights count from the edges of the box towards which gravity pulls.
double energy_of_height(const ShownDisc& disc, const Effects& effects, const Box& box) {
    const auto height = [](double place, double pull, double length) {
        return pull < 0 ? place : length - place;
    };
    const Acceleration& g = effects.gravity;
    return disc.has.mass * (std::fabs(g.x) * height(disc.x, g.x, box.x) +
                            std::fabs(g.y) * height(disc.y, g.y, box.y));
}

/// Whether discs under the acceleration `g` fall by over half the box's longer edge between syncs.
bool falls_too_far(const SceneParameters& scene, double g) {
    const double time = steps_between_syncs(scene), drag = scene.effects.drag;
    if (drag * time > longest_drag) return false; // check_times_of_drag reports it
    const double fall = drag > 0 ? dragged_fall(drag, drag_clock(drag, time)) : 0.5 * time * time;
    return std::fabs(g) * fall > 0.5 * scene.box.longest();
}

bool sways_too_fast(const SceneParameters& scene) {
    const Acceleration& g = scene.effects.gravity;
    return g.sways() && least_syncs * steps_between_syncs(scene) > g.period;
}

/// Makes syncs more frequent than the default if gravity is strong or changes fast. If even a sync
/// in each micro-step is not enough, check_fall or check_period reports it.
void shorten_sync(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    const Acceleration& g = scene.effects.gravity;
    const std::int64_t by_default = scene.sync_every;
    if (draft.settings.has("time.sync_every") || scene.box == Box()) return;
    const auto are_rare = [&] {
        return falls_too_far(scene, g.largest_x()) || falls_too_far(scene, g.largest_y()) ||
               sways_too_fast(scene);
    };
    while (scene.sync_every > 1 && are_rare()) scene.sync_every /= 2;
    if (are_rare()) scene.sync_every = by_default;
}

void check_period(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    if (!scene.effects.gravity.sways()) return;
    const double period = scene.effects.gravity.period;
    limit_contact_time(draft, period / 8, "an eighth of gravity's period");
    if (!draft.knows_syncs() || !sways_too_fast(scene)) return;
    const double longest = std::floor(period / least_syncs *
                                      static_cast<double>(scene.micro_steps));
    draft.refuse(
        {"effects.gravity.period"},
        fmt::format("'effects.gravity.period' = {} is less than {} times between syncs; {}", period,
                    least_syncs,
                    longest >= 1 ? fmt::format("time.sync_every = {} or less will do", longest)
                                 : fmt::format("time.micro_steps = {} or more will do",
                                               std::ceil(least_syncs / period))));
}

/// Limits the fall between two syncs. The falling frame must stay near the box, because coordinates
/// in a frame far away would be rounded more coarsely than those in the box.
void check_fall(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    if (!draft.knows_syncs()) return;
    const Acceleration& all = scene.effects.gravity;
    for (const auto& [key, g] :
         {std::pair("effects.gravity.x", all.amplitude_x == 0 ? all.x : all.largest_x()),
          {"effects.gravity.y", all.amplitude_y == 0 ? all.y : all.largest_y()}}) {
        if (!falls_too_far(scene, g)) continue;
        const double longest = std::floor(std::sqrt(scene.box.longest() / std::fabs(g)) *
                                          static_cast<double>(scene.micro_steps));
        draft.refuse({key},
                     fmt::format("'{}' = {} makes discs fall further than half the box "
                                 "from sync to sync; {}",
                                 key, g,
                                 longest >= 1
                                     ? fmt::format("time.sync_every = {} or less will do", longest)
                                     : "take more time.micro_steps"));
    }
}

std::string summary_of_gravity(const Effects& effects) {
    const Acceleration& g = effects.gravity;
    std::string text = g.is_on() ? fmt::format("gravity ({:g}, {:g})", g.x, g.y) : "";
    if (g.sways())
        text += fmt::format(" and amplitudes ({:g}, {:g}) of period {:g}", g.amplitude_x,
                            g.amplitude_y, g.period);
    return text;
}

/// Whether any side of the box exerts friction on discs, a force that depends on each contact.
bool do_surfaces_rub(const Effects& effects) {
    for (std::size_t side = 0; side < effects.boundaries.size(); ++side)
        if (does_rub(effects, side)) return true;
    return false;
}

} // namespace

namespace effects {

EffectDeclaration gravity() {
    return {
        .tables = {{"effects.gravity", "Uniform gravity."}},
        .keys = keys_of_gravity(),
        .rules = rules_of_gravity(),
        .derive = shorten_sync,
        .check_times = check_period,
        .check_room = check_fall,
        .summary = summary_of_gravity,
        .allowance =
            [](const Effects& e) {
                return CheckAllowance{.collisions_take_energy = e.gravity.is_on() && e.drag != 0,
                                      .walls_give_energy = e.gravity.sways() && do_surfaces_rub(e)};
            },
        .energy = [](const Effects& e) -> std::optional<OtherEnergy> {
            if (!e.gravity.is_steady()) return std::nullopt;
            return OtherEnergy{.name = "potential_energy",
                               .words = "of height",
                               .value = &Totals::potential_energy,
                               .of_disc = energy_of_height,
                               .largest = [](const Effects& at, const Box& box) {
                                   return (std::fabs(at.gravity.x) + std::fabs(at.gravity.y)) *
                                          box.longest();
                               }};
        },
        .lets_discs_rest = [](const Effects& e) { return e.gravity.is_on(); },
        .usual_speed =
            [](const SceneParameters& s) {
                const Acceleration& g = s.effects.gravity;
                return std::sqrt(2 * (g.largest_x() + g.largest_y()) * s.box.longest());
            },
        .common_motion =
            [](const Effects& e, Axis axis) {
                const Acceleration& g = e.gravity;
                return CommonMotion{.is_driven = along(axis, g.largest_x(), g.largest_y()) != 0};
            }};
}

} // namespace effects

} // namespace carrom
