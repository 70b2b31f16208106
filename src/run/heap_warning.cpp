// SPDX-License-Identifier: BSD-3-Clause
#include "run/heap_warning.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "dynamics/contact_guard.hpp"
#include "dynamics/contact_impulses.hpp"
#include "scene/key.hpp"
#include "scene/limits.hpp"

namespace carrom {

namespace {

constexpr std::string_view lasting_key = "effects.lasting_contacts.speed";

bool may_have_lasting_contacts(SceneParameters scene) {
    scene.effects.lasting_speed = 1;
    return std::none_of(rules().begin(), rules().end(), [&scene](const Rule& rule) {
        return std::find(rule.keys.begin(), rule.keys.end(), lasting_key) != rule.keys.end() &&
               rule.is_broken(scene);
    });
}

double smallest_radius(const SceneParameters& scene) {
    double radius = scene.radius;
    for (const Species& one : scene.effects.species) radius = std::min(radius, one.radius);
    return radius;
}

std::string remedy_of(const SceneParameters& scene) {
    if (!may_have_lasting_contacts(scene)) return "a longer effects.contact.contact_time";
    const double radius = smallest_radius(scene);
    // The advised speed is about 2 g T, with the acceleration g and the longest default time T
    // between syncs.
    const double pull = std::hypot(scene.effects.acceleration().x, scene.effects.acceleration().y);
    return fmt::format("{} = {:.1g}", lasting_key, 0.5 * std::sqrt(pull * radius));
}

/// The largest mean number of collisions of a disc between two syncs in normal flows with lasting
/// contacts. If lasting_contacts.speed is too small, it is about a hundred.
constexpr double most_where_lasting = 30;
/// The rate of collisions is averaged over this number of intervals between syncs.
constexpr std::int64_t intervals_of_flow = 16;
/// Warns only if the scene's lasting_contacts.speed is below this share of the advised speed.
constexpr double enough = 0.8;

/// The value, rounded up to one significant digit.
double rounded_up(double value) {
    const double digit = std::pow(10, std::floor(std::log10(value)));
    return value > 0 ? std::ceil(value / digit) * digit : 0;
}

} // namespace

HeapWarning::HeapWarning(const SceneParameters& scene, const DiscSystem& system,
                         const Communicator& ranks, Messages messages)
    : scene_(scene), system_(system), ranks_(ranks), messages_(std::move(messages)),
      is_watching_(may_warn(scene)) {
    if (!is_watching_) return;
    last_step_ = system_.step();
    last_collisions_ = n_collisions();
}

bool HeapWarning::may_warn(const SceneParameters& scene) {
    const Effects& effects = scene.effects;
    return effects.acceleration().is_on() && are_pairs_lossy(effects);
}

bool HeapWarning::act() {
    const std::int64_t steps = system_.step() - last_step_,
                       intervals = scene_.effects.lasting_speed > 0 ? intervals_of_flow : 1;
    if (!is_watching_ || steps == 0 || steps * scene_.micro_steps < intervals * scene_.sync_every)
        return true;
    const std::uint64_t collisions = n_collisions();
    const double per_step = static_cast<double>(collisions - last_collisions_) /
                            (static_cast<double>(steps) * static_cast<double>(scene_.n_discs));
    const std::string text = scene_.effects.lasting_speed > 0 ? text_on_flow(per_step)
                                                              : text_on_rest(per_step);
    if (!text.empty())
        messages_.warn("{}: warning: from step {} to {} each disc collided {:.2g} times in a step, "
                       "{}\n",
                       scene_.name, last_step_, system_.step(), per_step, text);
    is_watching_ = text.empty();
    last_step_ = system_.step();
    last_collisions_ = collisions;
    return true;
}

std::string HeapWarning::text_on_rest(double per_step) const {
    const Acceleration pull = scene_.effects.acceleration();
    const double per_contact_time = per_step *
                                    ContactGuard(scene_.effects, scene_.radius)
                                        .rest_time(std::hypot(pull.x, pull.y), scene_.radius);
    if (!(per_contact_time > 1)) return {};
    return fmt::format("which is {:.2g} times in a contact time: discs that lie on each other make "
                       "the run slow, and have no friction; try: {}",
                       per_contact_time, remedy_of(scene_));
}

std::string HeapWarning::text_on_flow(double per_step) const {
    const double time = static_cast<double>(scene_.sync_every) /
                        static_cast<double>(scene_.micro_steps);
    // If discs cannot flow for ever, they come to rest, and bursts of collisions end.
    if (!may_flow_on(scene_.effects) || !(per_step * time > most_where_lasting)) return {};
    // The advised speed is at least the speed after a fall by a radius, because the flow may still
    // become faster. It is below the limits at which the scene is an error or impacts lose too
    // much energy.
    const Acceleration pull = scene_.effects.acceleration();
    const double radius = smallest_radius(scene_),
                 fallen = std::sqrt(2 * std::hypot(pull.x, pull.y) * radius),
                 best = std::min({rounded_up(std::max(speed_of_passing(), fallen)),
                                  2 * radius / time, 2 * fallen});
    if (!(scene_.effects.lasting_speed < enough * best)) return {};
    return fmt::format("though contacts last that are slower than {:g}: discs flow past each other "
                       "faster than that, and bounce until the next sync; try: {} = {:.2g}",
                       scene_.effects.lasting_speed, lasting_key, best);
}

/// The root mean square of the discs' speeds relative to their mean velocity, both means weighted
/// by mass; in the scene's unit of length per step.
double HeapWarning::speed_of_passing() const {
    double mass = scene_.effects.species.empty() ? static_cast<double>(scene_.n_discs) : 0;
    for (const Species& one : scene_.effects.species)
        mass += static_cast<double>(one.count) * one.mass;
    const Totals totals = system_.energies();
    const double drift = std::hypot(totals.momentum_x, totals.momentum_y) / mass;
    return std::sqrt(std::max(0.0, 2 * totals.kinetic_energy / mass - drift * drift));
}

std::uint64_t HeapWarning::n_collisions() const {
    std::uint64_t mine = 0;
    for (const DiscState& disc : system_.discs())
        mine += disc.wall_collisions + disc.pair_collisions;
    return ranks_.sum(mine);
}

} // namespace carrom
