// SPDX-License-Identifier: BSD-3-Clause
// Uniform gravity (dynamics/gravity.hpp).
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "dynamics/drag.hpp"
#include "dynamics/gravity.hpp"
#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

std::vector<Key> keys_of_gravity() {
    return {
        key("effects.gravity.x", "length/step^2", "Acceleration along x.",
            [](auto& s) -> auto& { return s.effects.gravity.x; }),
        key("effects.gravity.y", "length/step^2", "Acceleration along y.",
            [](auto& s) -> auto& { return s.effects.gravity.y; }),
    };
}

/// Whether discs that gravity drives along periodic sides find a steady flow: something has to take
/// the momentum along the sides `low` and `low + 1`, and something the energy. Obstacles take
/// momentum, because discs have to go round them.
bool are_stopped(const SceneParameters& s, std::size_t low) {
    const Effects& e = s.effects;
    const ThermostatKind kind = e.thermostat.kind;
    if (e.drag != 0 || e.thermostat.is_bath()) return true;
    const Boundary *const first = &e.boundaries[low], *const last = first + 2;
    const auto any = [&](const auto& what) { return std::any_of(first, last, what); };
    const bool are_thermal = any(
        [](const Boundary& side) { return side.kind == BoundaryKind::thermal; });
    const auto takes_energy = [](const auto& body) {
        return body.restitution < 1 || std::fabs(body.surface.tangential_restitution) < 1;
    };
    const bool is_energy_taken = are_pairs_lossy(e) || kind == ThermostatKind::rescale ||
                                 any(takes_energy) ||
                                 (has_obstacles(s) && takes_energy(e.obstacles));
    const bool is_momentum_taken = has_obstacles(s) ||
                                   any([](const Boundary& side) { return side.surface.rubs(); });
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
                 return s.effects.gravity.is_any() && is_time_stepped(s);
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
        rule("gravity along periodic sides", "sheared sides",
             "nothing stops discs in a flow without walls",
             {"effects.gravity.x", "effects.gravity.y"},
             [](const SceneParameters& s) {
                 return s.effects.are_sheared() && s.effects.gravity.is_any();
             }),
    };
}

/// Above the walls that gravity pulls to at the start.
double energy_of_height(const ShownDisc& disc, const Effects& effects, const Box& box) {
    const auto height = [](double place, double pull, double length) {
        return pull < 0 ? place : length - place;
    };
    const Gravity& g = effects.gravity;
    return disc.has.mass * (std::fabs(g.x) * height(disc.x, g.x, box.x) +
                            std::fabs(g.y) * height(disc.y, g.y, box.y));
}

/// Whether what is pulled with `g` falls by more than half the box from sync to sync.
bool falls_too_far(const SceneParameters& scene, double g) {
    const double time = steps_between_syncs(scene), drag = scene.effects.drag;
    if (drag * time > longest_drag) return false; // a problem already
    const double fall = drag > 0 ? dragged_fall(drag, drag_clock(drag, time)) : 0.5 * time * time;
    return std::fabs(g) * fall > 0.5 * scene.box.longest();
}

/// Strong gravity needs syncs that follow each other sooner than they do by default. Where one in
/// each micro-step is too late, check_fall says so.
void shorten_sync(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    const Gravity& g = scene.effects.gravity;
    const std::int64_t by_default = scene.sync_every;
    if (draft.settings.has("time.sync_every") || scene.box == Box()) return;
    while (scene.sync_every > 1 && (falls_too_far(scene, g.x) || falls_too_far(scene, g.y)))
        scene.sync_every /= 2;
    if (falls_too_far(scene, g.x) || falls_too_far(scene, g.y)) scene.sync_every = by_default;
}

/// The falling frame must not leave the box far behind: its coordinates would be coarser than the
/// box's.
void check_fall(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    if (!draft.knows_syncs()) return;
    for (const auto& [key, g] : {std::pair("effects.gravity.x", scene.effects.gravity.x),
                                 {"effects.gravity.y", scene.effects.gravity.y}}) {
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

} // namespace

namespace effects {

EffectDeclaration gravity() {
    return {.tables = {{"effects.gravity", "Uniform gravity."}},
            .keys = keys_of_gravity(),
            .rules = rules_of_gravity(),
            .derive = shorten_sync,
            .check_room = check_fall,
            .summary =
                [](const Effects& e) {
                    return e.gravity.is_any()
                               ? fmt::format("gravity ({:g}, {:g})", e.gravity.x, e.gravity.y)
                               : "";
                },
            .allowance =
                [](const Effects& e) {
                    return CheckAllowance{.collisions_take_energy = e.gravity.is_any() &&
                                                                    e.drag != 0};
                },
            .energy = [](const Effects& e) -> std::optional<OtherEnergy> {
                if (!e.gravity.is_any()) return std::nullopt;
                return OtherEnergy{.name = "potential_energy",
                                   .words = "of height",
                                   .value = &Totals::potential_energy,
                                   .of_disc = energy_of_height,
                                   .largest = [](const Effects& at, const Box& box) {
                                       return (std::fabs(at.gravity.x) + std::fabs(at.gravity.y)) *
                                              box.longest();
                                   }};
            },
            .lets_discs_rest = [](const Effects& e) { return e.gravity.is_any(); },
            .usual_speed =
                [](const SceneParameters& s) {
                    const Gravity& g = s.effects.gravity;
                    return std::sqrt(2 * (std::fabs(g.x) + std::fabs(g.y)) * s.box.longest());
                },
            .common_motion =
                [](const Effects& e, Axis axis) {
                    return CommonMotion{.is_driven = along(axis, e.gravity.x, e.gravity.y) != 0};
                }};
}

} // namespace effects

} // namespace carrom
