// SPDX-License-Identifier: BSD-3-Clause
#include "run/heap_warning.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "dynamics/contact_guard.hpp"
#include "scene/key.hpp"

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

std::string remedy_of(const SceneParameters& scene) {
    if (!may_have_lasting_contacts(scene)) return "a longer effects.contact.contact_time";
    double radius = scene.radius;
    for (const Species& one : scene.effects.species) radius = std::min(radius, one.radius);
    // Some 2 g T for the longest time T between syncs that the effect takes by default.
    const double pull = std::hypot(scene.effects.gravity.x, scene.effects.gravity.y);
    return fmt::format("{} = {:.1g}", lasting_key, 0.5 * std::sqrt(pull * radius));
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
    return effects.gravity.is_any() && are_pairs_lossy(effects) && effects.lasting_speed == 0;
}

bool HeapWarning::act() {
    const std::int64_t steps = system_.step() - last_step_;
    if (!is_watching_ || steps == 0 || steps * scene_.micro_steps < scene_.sync_every) return true;
    const std::uint64_t collisions = n_collisions();
    const double per_step = static_cast<double>(collisions - last_collisions_) /
                            (static_cast<double>(steps) * static_cast<double>(scene_.n_discs));
    const Gravity& gravity = scene_.effects.gravity;
    const double per_contact_time = per_step *
                                    ContactGuard(scene_.effects, scene_.radius)
                                        .rest_time(std::hypot(gravity.x, gravity.y), scene_.radius);
    if (per_contact_time > 1) {
        messages_.warn(
            "{}: warning: from step {} to {} each disc collided {:.2g} times in a step, which is "
            "{:.2g} times in a contact time: discs that lie on each other make the run slow, and "
            "have no friction; try: {}\n",
            scene_.name, last_step_, system_.step(), per_step, per_contact_time, remedy_of(scene_));
        is_watching_ = false;
    }
    last_step_ = system_.step();
    last_collisions_ = collisions;
    return true;
}

std::uint64_t HeapWarning::n_collisions() const {
    std::uint64_t mine = 0;
    for (const DiscState& disc : system_.discs())
        mine += disc.wall_collisions + disc.pair_collisions;
    return ranks_.sum(mine);
}

} // namespace carrom
