// SPDX-License-Identifier: BSD-3-Clause
// Active discs: each has a direction, an angle phi, in which a force pushes it.
//
// With the friction of a thermostat of kind "langevin" the velocity follows
//   dv = -rate (v - u e(phi)) dt + noise,   u = force / (mass rate),   e = (cos, sin),
// and the direction changes in two ways, each at its own rate (M. E. Cates and J. Tailleur, EPL
// 101, 20010 (2013)):
//   rotation   dphi = sqrt(2 D) dW: active Brownian discs
//   tumbles    at random times phi gets a new value, all equally likely: run and tumble
// At a sync, a time t after the previous one, the change of the direction is drawn from its exact
// distribution for that time. Then v += (1 - exp(-rate t)) u e. Together with the thermostat this
// is the exact solution for a constant force. The only error is that directions and velocities are
// constant between syncs. For a free disc it increases the active part of the diffusion coefficient
// by the fraction (D t)^2 / 12, and the thermal part by (rate t)^2 / 12.
//
// Neither collisions nor the spins of rough discs change directions.
#include <cmath>

#include <fmt/format.h>

#include "core/angle.hpp"
#include "dynamics/drag.hpp"
#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

class Propulsion final : public SyncEffect {
public:
    explicit Propulsion(const SceneParameters& scene) {
        const Effects effects = per_micro_step(scene);
        const Activity& activity = effects.activity;
        const auto interval = static_cast<double>(scene.sync_every);
        const double friction = effects.thermostat.rate,
                     lost = 1 - drag_slowing(friction, interval);
        seed_ = activity.seed;
        speed_ = activity.speed * lost;
        momentum_ = activity.force / friction * lost;
        spread_ = std::sqrt(2 * activity.rotational_diffusion * interval);
        kept_ = drag_slowing(activity.tumble_rate, interval);
    }

    void act(const SyncDiscs& at) override {
        at.in_parts([&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                DiscState& disc = at.discs[i];
                if (disc.has_departed()) continue;
                double& angle = at.directions[i];
                angle = later(angle, {seed_, Purpose::direction, disc.id,
                                      static_cast<std::uint64_t>(at.n_syncs)});
                const Direction along = direction_of(angle);
                const double push = momentum_ == 0 ? speed_
                                                   : momentum_ / at.species.of(disc.id).mass;
                disc.vx += push * along.x;
                disc.vy += push * along.y;
            }
        });
    }

private:
    /// Draws the direction from this sync on. `angle`: the direction since the previous sync.
    double later(double angle, DiscRandom random) const {
        if (kept_ < 1 && random.uniform() >= kept_) return random_angle(random);
        return wrapped_angle(spread_ > 0 ? angle + spread_ * random_normals(random).x : angle);
    }

    std::uint64_t seed_;
    double speed_, momentum_; ///< speed or momentum that a disc gains at a sync; the other is 0
    double spread_;           ///< root mean square of the change of angle between syncs
    double kept_;             ///< probability that a disc does not tumble between syncs
};

const Need active{"without effects.activity.speed or effects.activity.force",
                  [](const SceneParameters& s) { return s.effects.activity.is_on(); }};

std::vector<Key> keys_of_activity() {
    return {
        key("effects.activity.speed", "length/step",
            "Propulsion: the speed that a free disc would reach if its direction stayed.",
            [](auto& s) -> auto& { return s.effects.activity.speed; })
            .within({.low = 0}),
        key("effects.activity.force", "mass length/step^2",
            "Propulsion by a force that is the same for all masses, in place of a speed.",
            [](auto& s) -> auto& { return s.effects.activity.force; })
            .within({.low = 0})
            .excludes({"effects.activity.speed"}),
        key("effects.activity.rotational_diffusion", "1/step",
            "D of the directions, in rad^2/step: the mean square of the angle that a disc has "
            "turned grows by 2 D in a step. At most 4 per time between syncs.",
            [](auto& s) -> auto& { return s.effects.activity.rotational_diffusion; })
            .within({.low = 0})
            .needs(active),
        key("effects.activity.tumble_rate", "1/step",
            "How often a disc takes a new direction, which may be any. At most 4 per time between "
            "syncs.",
            [](auto& s) -> auto& { return s.effects.activity.tumble_rate; })
            .within({.low = 0})
            .needs(active),
        key("effects.activity.seed", "1",
            "Seed of the directions. Those at the start are random, too, unless "
            "'discs.species' or 'discs.columns' give some other than 0.",
            [](auto& s) -> auto& { return s.effects.activity.seed; })
            .within({.low = 0})
            .needs(active)
            .seed(),
    };
}

std::vector<Rule> rules_of_activity() {
    const RuleKeys keys = {"effects.activity.speed", "effects.activity.force"};
    return {
        rule("active discs", "no friction",
             "a force that never ends needs one; take effects.thermostat.kind = \"langevin\"", keys,
             [](const SceneParameters& s) {
                 return s.effects.activity.is_on() &&
                        s.effects.thermostat.kind != ThermostatKind::langevin;
             }),
        rule("active discs", "sheared sides", "the flow would have to turn their directions", keys,
             [](const SceneParameters& s) {
                 return s.effects.activity.is_on() && s.effects.are_sheared();
             }),
        rule("directions in discs.columns", "discs that are not active",
             "directions have no meaning without effects.activity", {"discs.columns"},
             [](const SceneParameters& s) {
                 return has_column(s, disc_column_of(SideColumn::direction)) &&
                        !s.effects.activity.is_on();
             }),
    };
}

/// Reports rates so high that a direction hardly depends on the one at the previous sync.
void check_times_of_activity(const SceneDraft& draft) {
    constexpr double longest = 4;
    const Activity& activity = draft.scene.effects.activity;
    const double interval = steps_between_syncs(draft.scene);
    for (const auto& [key, rate] :
         {std::pair("effects.activity.rotational_diffusion", activity.rotational_diffusion),
          {"effects.activity.tumble_rate", activity.tumble_rate}})
        if (rate * interval > longest)
            draft.refuse({key}, fmt::format("'{}' = {} acts more than {} times between two syncs: "
                                            "{:g} at most, or a smaller time.sync_every",
                                            key, rate, longest, longest / interval));
}

/// The speed that the lightest discs reach if they are free and their directions do not change.
double speed_of(const SceneParameters& scene) {
    const Activity& activity = scene.effects.activity;
    if (activity.force == 0 || scene.effects.thermostat.rate == 0) return activity.speed;
    double lightest = scene.effects.species.empty() ? 1 : scene.effects.species.front().mass;
    for (const Species& one : scene.effects.species) lightest = std::min(lightest, one.mass);
    return activity.force / (lightest * scene.effects.thermostat.rate);
}

void check_room_of_activity(const SceneDraft& draft) {
    if (!draft.scene.effects.activity.is_on()) return;
    const std::string_view key = draft.scene.effects.activity.force == 0 ? "effects.activity.speed"
                                                                         : "effects.activity.force";
    const std::string text = speed_problem(speed_of(draft.scene), draft.scene);
    if (!text.empty()) draft.refuse({key}, fmt::format("'{}': {}", key, text));
}

std::string summary_of_activity(const Effects& effects) {
    const Activity& activity = effects.activity;
    if (!activity.is_on()) return {};
    std::string text = activity.force == 0
                           ? fmt::format("active discs of speed {:g}", activity.speed)
                           : fmt::format("active discs of force {:g}", activity.force);
    if (activity.rotational_diffusion != 0)
        text += fmt::format(", rotational diffusion {:g}", activity.rotational_diffusion);
    if (activity.tumble_rate != 0) text += fmt::format(", tumble rate {:g}", activity.tumble_rate);
    return text;
}

} // namespace

namespace effects {

EffectDeclaration activity() {
    return {
        .tables = {{"effects.activity", "Discs that propel themselves."}},
        .keys = keys_of_activity(),
        .rules = rules_of_activity(),
        .check_times = check_times_of_activity,
        .check_room = check_room_of_activity,
        .summary = summary_of_activity,
        .allowance =
            [](const Effects& e) { return CheckAllowance{.acts_at_syncs = e.activity.is_on()}; },
        .usual_speed = speed_of,
        .at_syncs = [](const SceneParameters& s) -> std::unique_ptr<SyncEffect> {
            if (!s.effects.activity.is_on()) return nullptr;
            return std::make_unique<Propulsion>(s);
        },
        .reason_without_z =
            [](const Effects& e) {
                return std::string(e.activity.is_on()
                                       ? "no Z, because active discs push on walls by their "
                                         "swim pressure, too"
                                       : "");
            }};
}

} // namespace effects

} // namespace carrom
