// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "scene/boundaries/boundary.hpp"

namespace carrom {

std::string summary_of(const Effects& effects) {
    std::string text;
    const auto add = [&text](const std::string& more) {
        if (!more.empty()) text += (text.empty() ? "" : "; ") + more;
    };
    const auto add_if = [&](const EffectDeclaration& effect) {
        if (effect.summary) add(effect.summary(effects));
    };
    // The order of the summary: contacts of discs, their species, the sides of the box, and then
    // all other effects.
    const std::span all(all_effects());
    add_if(all.front());
    add(description(effects.species));
    add(summary_of_boundaries(effects));
    std::ranges::for_each(all.subspan(1), add_if);
    return text;
}

CheckAllowance allowance_of(const Effects& effects) {
    CheckAllowance all = allowance_of_boundaries(effects);
    for (const EffectDeclaration& effect : all_effects()) {
        if (!effect.allowance) continue;
        const CheckAllowance one = effect.allowance(effects);
        all.collisions_take_energy |= one.collisions_take_energy;
        all.walls_give_energy |= one.walls_give_energy;
        all.acts_at_syncs |= one.acts_at_syncs;
        all.acts_before_flights |= one.acts_before_flights;
        all.surfaces_give_energy |= one.surfaces_give_energy;
    }
    return all;
}

std::vector<OtherEnergy> other_energies_of(const Effects& effects) {
    std::vector<OtherEnergy> all;
    for (const EffectDeclaration& effect : all_effects())
        if (effect.energy)
            if (const auto one = effect.energy(effects)) all.push_back(*one);
    return all;
}

double energy_left_by(const Effects& effects, double time) {
    double left = 1;
    for (const EffectDeclaration& effect : all_effects())
        if (effect.energy_left) left *= effect.energy_left(effects, time);
    return left;
}

double work_on_way(const Effects& effects, const Way& way) {
    double work = 0;
    for (const EffectDeclaration& effect : all_effects())
        if (effect.work) work += effect.work(effects, way);
    return work;
}

double work_in_collision(const Effects& effects, double impulse, double radii) {
    double work = 0;
    for (const EffectDeclaration& effect : all_effects())
        if (effect.work_in_collision) work += effect.work_in_collision(effects, impulse, radii);
    return work;
}

double usual_speed_of_effects(const SceneParameters& scene) {
    double speed = 0;
    for (const EffectDeclaration& effect : all_effects())
        if (effect.usual_speed) speed = std::max(speed, effect.usual_speed(scene));
    return speed;
}

/// `kept` contains, for each effect at syncs, the number of its values and then the values. It is
/// empty if no effect keeps values.
std::vector<EndNumber> end_numbers_of(const SceneParameters& scene,
                                      std::span<const std::int64_t> kept) {
    std::vector<EndNumber> numbers;
    for (const EffectDeclaration& effect : all_effects()) {
        if (!effect.at_syncs || !effect.at_syncs(scene)) continue;
        const auto n = kept.empty() ? 0 : static_cast<std::size_t>(kept.front());
        if (!kept.empty()) kept = kept.subspan(1);
        if (effect.at_end)
            for (const EndNumber& number : effect.at_end(kept.first(n))) numbers.push_back(number);
        kept = kept.subspan(n);
    }
    return numbers;
}

std::string reason_without_z(const Effects& effects) {
    for (const EffectDeclaration& effect : all_effects()) {
        std::string reason = effect.reason_without_z ? effect.reason_without_z(effects) : "";
        if (!reason.empty()) return reason;
    }
    return {};
}

Drift drift_along(Axis axis, const Effects& effects) {
    if (!(axis == Axis::x ? effects.is_periodic_x() : effects.is_periodic_y()))
        return Drift::is_heat;
    CommonMotion all;
    for (const EffectDeclaration& effect : all_effects()) {
        if (!effect.common_motion) continue;
        const CommonMotion one = effect.common_motion(effects, axis);
        all.is_stopped |= one.is_stopped;
        all.is_driven |= one.is_driven;
    }
    if (all.is_driven) return Drift::is_driven;
    return all.is_stopped ? Drift::is_heat : Drift::is_kept;
}

std::string reason_without_temperature(const Effects& effects, std::uint64_t n_discs) {
    const bool has_x = drift_along(Axis::x, effects) == Drift::is_heat,
               has_y = drift_along(Axis::y, effects) == Drift::is_heat;
    if (n_discs != 1 || (has_x && has_y)) return {};
    return fmt::format("no kT, P or Z: along {} the only disc has no motion about the mean of all",
                       has_x   ? "y"
                       : has_y ? "x"
                               : "x and y");
}

std::vector<std::string> settings_of_effect_files(const SceneParameters& scene) {
    std::vector<std::string> all;
    for (const EffectDeclaration& effect : all_effects()) {
        if (!effect.settings_of_file) continue;
        const std::vector<std::string> some = effect.settings_of_file(scene);
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

SyncEffects sync_effects_of(const SceneParameters& scene) {
    SyncEffects acting;
    for (const EffectDeclaration& effect : all_effects())
        if (effect.at_syncs)
            if (auto one = effect.at_syncs(scene)) acting.push_back(std::move(one));
    return acting;
}

} // namespace carrom
