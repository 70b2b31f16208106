// SPDX-License-Identifier: BSD-3-Clause
// Thermostats: they act on velocities and spins at syncs, every `time.sync_every` micro-steps.
//
// After a time t between syncs, with independent normal numbers n of mean 0 and variance 1:
//   kicks     v += xi sqrt(t) n, minus the mass-weighted mean of all kicks, so that the total
//             momentum is conserved.
//             White noise of strength xi^2 in the limit of short t (van Noije and Ernst, Granular
//             Matter 1, 57 (1998)). xi is the same for all masses. Spins do not change.
//   andersen  with the probability 1 - exp(-rate t) a disc gets a velocity and spin from Maxwell's
//             distribution (Andersen, J. Chem. Phys. 72, 2384 (1980)).
//   langevin  v = c v + sqrt((1 - c^2) kT / m) n with c = exp(-rate t): the exact solution of
//             dv = -rate v dt + sqrt(2 rate kT / m) dW, the process of Ornstein and Uhlenbeck.
//   rescale   velocities relative to the centre of mass, and spins, are multiplied by the factor
//             that makes their mean energy per disc kT, or 3/2 kT if discs have spins. Nothing
//             changes if all discs have the same velocity, for example if there is only one disc.
// For spins the moment of inertia takes the place of the mass. Between sheared sides all velocities
// are relative to the flow.
//
// Only + - * / and sqrt are used, so the bits are the same on every machine.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "dynamics/drag.hpp"
#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"

namespace carrom {

template <>
inline constexpr std::array words_of<ThermostatKind>{
    Word{"none", ThermostatKind::none}, Word{"kicks", ThermostatKind::kicks},
    Word{"andersen", ThermostatKind::andersen}, Word{"langevin", ThermostatKind::langevin},
    Word{"rescale", ThermostatKind::rescale}};

namespace {

/// The base class of all thermostats. Its unit of time is the micro-step.
class ThermostatEffect : public SyncEffect {
public:
    explicit ThermostatEffect(const SceneParameters& scene)
        : setting_(per_micro_step(scene).thermostat), inertia_(scene.effects.contact.inertia),
          interval_(static_cast<double>(scene.sync_every)),
          n_discs_(static_cast<double>(scene.n_discs)) {
        heaviest_ = scene.effects.species.empty() ? 1 : 0;
        for (const Species& one : scene.effects.species) heaviest_ = std::max(heaviest_, one.mass);
    }

protected:
    DiscRandom random_of(const SyncDiscs& at, DiscId id) const {
        return {setting_.seed, Purpose::sync, id, static_cast<std::uint64_t>(at.n_syncs)};
    }
    /// Root mean square of a velocity component in equilibrium; `thermal_spin` is that of the spin.
    double thermal_speed(const SizeAndMass& body) const {
        return std::sqrt(setting_.temperature / body.mass);
    }
    double thermal_spin(const SizeAndMass& body) const {
        return thermal_speed(body) / (body.radius * std::sqrt(inertia_));
    }
    /// Calls what(i, random numbers of disc i) for each disc in the box.
    template <class What> void for_each(const SyncDiscs& at, const What& what) const {
        at.in_parts([&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                if (!at.discs[i].has_departed()) what(i, random_of(at, at.discs[i].id));
        });
    }

    Thermostat setting_;
    double inertia_, interval_, n_discs_, heaviest_ = 1;
};

class Kicks final : public ThermostatEffect {
public:
    using ThermostatEffect::ThermostatEffect;

    void act(const SyncDiscs& at) override {
        const double size = std::sqrt(setting_.strength * interval_);
        // Normal numbers above 2^10 do not occur, because their probability is exp(-2^19).
        const double bound = n_discs_ * heaviest_ * size * 0x1p10;
        std::vector<ExactSum> sums(2, ExactSum(bound));
        sums.emplace_back(2 * n_discs_ * heaviest_);
        const auto kick_by = [size](DiscRandom random) {
            const NormalPair n = random_normals(random);
            return NormalPair{size * n.x, size * n.y};
        };
        at.add_up(sums, [&](std::size_t i, std::vector<ExactSum>& parts) {
            const DiscId id = at.discs[i].id;
            const NormalPair kick = kick_by(random_of(at, id));
            const double mass = at.species.of(id).mass;
            parts[0].add(mass * kick.x);
            parts[1].add(mass * kick.y);
            parts[2].add(mass);
        });
        const double mass = sums[2].value();
        if (!(mass > 0)) return;
        const double mean_x = sums[0].value() / mass, mean_y = sums[1].value() / mass;
        for_each(at, [&](std::size_t i, DiscRandom random) {
            const NormalPair kick = kick_by(random);
            at.discs[i].vx += kick.x - mean_x;
            at.discs[i].vy += kick.y - mean_y;
        });
    }
};

class Andersen final : public ThermostatEffect {
public:
    using ThermostatEffect::ThermostatEffect;

    void act(const SyncDiscs& at) override {
        const double kept = drag_slowing(setting_.rate, interval_);
        for_each(at, [&](std::size_t i, DiscRandom random) {
            if (random.uniform() < kept) return;
            DiscState& disc = at.discs[i];
            const SizeAndMass& body = at.species.of(disc.id);
            const double speed = thermal_speed(body);
            const NormalPair n = random_normals(random);
            disc.vx = speed * n.x;
            disc.vy = speed * n.y;
            if (!at.spins.empty()) at.spins[i] = thermal_spin(body) * random_normals(random).x;
        });
    }
};

class Langevin final : public ThermostatEffect {
public:
    using ThermostatEffect::ThermostatEffect;

    void act(const SyncDiscs& at) override {
        const double kept = drag_slowing(setting_.rate, interval_);
        const double noise = std::sqrt((1 - kept) * (1 + kept));
        for_each(at, [&](std::size_t i, DiscRandom random) {
            DiscState& disc = at.discs[i];
            const SizeAndMass& body = at.species.of(disc.id);
            const double speed = noise * thermal_speed(body);
            const NormalPair n = random_normals(random);
            disc.vx = kept * disc.vx + speed * n.x;
            disc.vy = kept * disc.vy + speed * n.y;
            if (at.spins.empty()) return;
            at.spins[i] = kept * at.spins[i] +
                          noise * thermal_spin(body) * random_normals(random).x;
        });
    }
};

class Rescale final : public ThermostatEffect {
public:
    using ThermostatEffect::ThermostatEffect;

    void act(const SyncDiscs& at) override {
        double largest = 0; // of velocity components and speeds of rough surfaces
        for (std::size_t i = 0; i < at.discs.size(); ++i)
            largest = std::max({largest, std::fabs(at.discs[i].vx), std::fabs(at.discs[i].vy),
                                std::fabs(speed_of_surface(at, i))});
        largest = at.largest_over_ranks(largest);
        if (!(largest > 0)) return; // all discs are at rest
        const double mass_bound = 2 * n_discs_ * heaviest_;
        std::vector<ExactSum> sums{ExactSum(mass_bound * largest), ExactSum(mass_bound * largest),
                                   ExactSum(mass_bound), ExactSum(2 * n_discs_)};
        at.add_up(sums, [&](std::size_t i, std::vector<ExactSum>& parts) {
            const double mass = at.species.of(at.discs[i].id).mass;
            parts[0].add(mass * at.discs[i].vx);
            parts[1].add(mass * at.discs[i].vy);
            parts[2].add(mass);
            parts[3].add(1);
        });
        if (!(sums[2].value() > 0)) return;
        const double mean_x = sums[0].value() / sums[2].value(),
                     mean_y = sums[1].value() / sums[2].value(), n = sums[3].value();
        std::vector<ExactSum> energy(1, ExactSum(16 * mass_bound * largest * largest));
        at.add_up(energy, [&](std::size_t i, std::vector<ExactSum>& parts) {
            const DiscState& disc = at.discs[i];
            const double wx = disc.vx - mean_x, wy = disc.vy - mean_y,
                         turning = speed_of_surface(at, i), mass = at.species.of(disc.id).mass;
            parts[0].add(0.5 * mass * (wx * wx + wy * wy + inertia_ * (turning * turning)));
        });
        const double now = energy[0].value(), blur = 0x1p-48 * largest;
        // If all discs have the same velocity, they differ from the mean only by rounding errors,
        // which must not be amplified.
        if (!(now > sums[2].value() * blur * blur)) return;
        const double wanted = n * setting_.temperature * (at.spins.empty() ? 1 : 1.5);
        const double factor = std::sqrt(wanted / now);
        at.in_parts([&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                DiscState& disc = at.discs[i];
                if (disc.has_departed()) continue;
                disc.vx = mean_x + factor * (disc.vx - mean_x);
                disc.vy = mean_y + factor * (disc.vy - mean_y);
                if (!at.spins.empty()) at.spins[i] *= factor;
            }
        });
    }

private:
    static double speed_of_surface(const SyncDiscs& at, std::size_t i) {
        return at.spins.empty() ? 0 : at.species.of(at.discs[i].id).radius * at.spins[i];
    }
};

using Kinds = std::initializer_list<ThermostatKind>;

Need kinds(std::string text, Kinds kinds) {
    return {"without effects.thermostat.kind = " + std::move(text),
            [all = std::vector(kinds)](const SceneParameters& s) {
                return std::find(all.begin(), all.end(), s.effects.thermostat.kind) != all.end();
            }};
}

std::vector<std::pair<std::string_view, std::string_view>> words_of_other_programs() {
    constexpr std::string_view canonical = "\"langevin\" or \"andersen\", which have the same "
                                           "equilibrium",
                               scaled = "\"rescale\"";
    return {{"nosehoover", canonical},
            {"nvt", canonical},
            {"csvr", canonical},
            {"bussi", canonical},
            {"berendsen", scaled},
            {"gaussian", scaled},
            {"isokinetic", scaled},
            {"velocityrescaling", scaled},
            {"vrescale", scaled},
            {"whitenoise", "\"kicks\""},
            {"stochastic", "\"kicks\" or \"langevin\""},
            {"dpd", "\"kicks\", which keep the total momentum"},
            {"brownian", "\"langevin\""}};
}

std::vector<Key> keys_of_thermostat() {
    using Kind = ThermostatKind;
    return {
        key("effects.thermostat.kind", "",
            "What is done to velocities at syncs. Kicks: white noise. Andersen: some discs get new "
            "ones. Langevin: friction and noise. Rescale: all are multiplied. Between sheared "
            "sides velocities about the flow are meant.",
            [](auto& s) -> auto& { return s.effects.thermostat.kind; })
            .advises(words_of_other_programs()),
        key("effects.thermostat.strength", "length^2/step^3",
            "xi^2 of the noise: free discs gain xi^2 of the mean square of each component in a "
            "step.",
            [](auto& s) -> auto& { return s.effects.thermostat.strength; })
            .within({1e-60, 1e60})
            .needs(kinds("\"kicks\"", {Kind::kicks}))
            .required(),
        key("effects.thermostat.rate", "1/step",
            "How often a disc gets a new velocity (Andersen), or the friction gamma (Langevin). At "
            "most 4 per time between syncs.",
            [](auto& s) -> auto& { return s.effects.thermostat.rate; })
            .within({.low = 0, .excludes_low = true})
            .needs(kinds("\"andersen\" or \"langevin\"", {Kind::andersen, Kind::langevin}))
            .required(),
        key("effects.thermostat.temperature", "length^2/step^2",
            "kT, for discs of mass 1. Rescale: the mean energy of a disc, relative to the centre "
            "of mass.",
            [](auto& s) -> auto& { return s.effects.thermostat.temperature; })
            .within({1e-60, 1e60})
            .needs(kinds("\"andersen\", \"langevin\" or \"rescale\"",
                         {Kind::andersen, Kind::langevin, Kind::rescale}))
            .required(),
        key("effects.thermostat.seed", "1", "Seed of the random numbers of the thermostat.",
            [](auto& s) -> auto& { return s.effects.thermostat.seed; })
            .within({.low = 0})
            .needs(kinds("\"kicks\", \"andersen\" or \"langevin\"",
                         {Kind::kicks, Kind::andersen, Kind::langevin}))
            .seed(),
    };
}

std::vector<Rule> rules_of_thermostat() {
    return {{"a thermostat",
             "drag",
             "both slow discs down; kind = \"langevin\" has a friction of its own",
             {"effects.thermostat.kind"},
             {},
             [](const SceneParameters& s) {
                 return s.effects.thermostat.is_on() && s.effects.drag != 0;
             }}};
}

/// Limits the time between syncs, because discs would lose almost all their velocity at each sync.
void check_times_of_thermostat(const SceneDraft& draft) {
    constexpr double longest = 4;
    const SceneParameters& scene = draft.scene;
    const double interval = static_cast<double>(scene.sync_every) /
                            static_cast<double>(scene.micro_steps);
    const double rate = scene.effects.thermostat.rate;
    if (!scene.effects.thermostat.is_on() || !(rate * interval > longest)) return;
    draft.refuse({"effects.thermostat.rate"},
                 fmt::format("'effects.thermostat.rate' = {} acts more than {} times between two "
                             "syncs: {:g} at most, or a smaller time.sync_every",
                             rate, longest, longest / interval));
}

/// Energy jumps at syncs, unless only a bath (andersen, langevin) changes the energy.
bool makes_energy_jump(const Effects& effects) {
    const CheckAllowance others = allowance_of(effects);
    return effects.thermostat.is_on() &&
           (!effects.thermostat.is_bath() || others.collisions_take_energy ||
            others.walls_give_energy || effects.are_sheared());
}

/// Checks that the thermal speed at mass 1 and the root mean square of a kick are valid speeds.
void check_room_of_thermostat(const SceneDraft& draft) {
    const Thermostat& t = draft.scene.effects.thermostat;
    const double of_kick = std::sqrt(t.strength * steps_between_syncs(draft.scene));
    for (const auto& [key, speed] :
         {std::pair("effects.thermostat.temperature", std::sqrt(t.temperature)),
          {"effects.thermostat.strength", of_kick}}) {
        const std::string text = speed_problem(speed, draft.scene);
        if (!text.empty()) draft.refuse({key}, fmt::format("'{}': {}", key, text));
    }
    check_energy_jumps(draft);
}

std::string summary_of_thermostat(const Effects& effects) {
    const Thermostat& t = effects.thermostat;
    switch (t.kind) {
    case ThermostatKind::none: return {};
    case ThermostatKind::kicks: return fmt::format("kicks of strength {:g}", t.strength);
    case ThermostatKind::andersen:
        return fmt::format("Andersen thermostat of rate {:g}, kT = {:g}", t.rate, t.temperature);
    case ThermostatKind::langevin:
        return fmt::format("Langevin thermostat of rate {:g}, kT = {:g}", t.rate, t.temperature);
    case ThermostatKind::rescale:
        return fmt::format("velocities rescaled to kT = {:g}", t.temperature);
    }
    return {};
}

/// A typical speed, as a length per step: the thermal speed, or for kicks about the speed that a
/// disc at rest gains while it moves by one radius.
double usual_speed_of_thermostat(const SceneParameters& scene) {
    const Thermostat& t = scene.effects.thermostat;
    return std::max(std::sqrt(t.temperature), std::cbrt(t.strength * scene.radius));
}

std::unique_ptr<SyncEffect> thermostat_at_syncs(const SceneParameters& scene) {
    switch (scene.effects.thermostat.kind) {
    case ThermostatKind::none: break;
    case ThermostatKind::kicks: return std::make_unique<Kicks>(scene);
    case ThermostatKind::andersen: return std::make_unique<Andersen>(scene);
    case ThermostatKind::langevin: return std::make_unique<Langevin>(scene);
    case ThermostatKind::rescale: return std::make_unique<Rescale>(scene);
    }
    return nullptr;
}

} // namespace

namespace effects {

EffectDeclaration thermostat() {
    return {
        .tables = {{"effects.thermostat", "What keeps discs moving, or at a temperature."}},
        .keys = keys_of_thermostat(),
        .rules = rules_of_thermostat(),
        .check_times = check_times_of_thermostat,
        .check_room = check_room_of_thermostat,
        .summary = summary_of_thermostat,
        .allowance =
            [](const Effects& e) { return CheckAllowance{.acts_at_syncs = e.thermostat.is_on()}; },
        .usual_speed = usual_speed_of_thermostat,
        .at_syncs = thermostat_at_syncs,
        .makes_energy_jump = makes_energy_jump,
        .common_motion = [](const Effects& e,
                            Axis) { return CommonMotion{.is_stopped = e.thermostat.is_bath()}; }};
}

} // namespace effects

} // namespace carrom
