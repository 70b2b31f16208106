// SPDX-License-Identifier: BSD-3-Clause
#include "setting_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include <fmt/format.h>

namespace carrom {

namespace {

constexpr double approach = 10;           ///< collisions of a disc before anything is measured
constexpr double certainty = 2;           ///< standard errors that are added to a measured error
constexpr double most_collisions = 4e6;   ///< of pairs, per trial
constexpr double least_accuracy = 4 * certainty / 2000; ///< what so many can tell, four times: 2000^2 = 4e6
constexpr double fewest_collisions = 2e4; ///< of pairs, and so many times the discs: less is too short to be timed
constexpr double fewest_per_disc = 2;
constexpr std::int64_t most_micro_steps = 1 << 20;

struct Choice {
    RunSetting setting;
    std::string reason;
};

/// Pairs that have to collide for errors of `accuracy` to stand out from the noise of two trials.
double collisions_needed(double accuracy) { return std::min(most_collisions, std::pow(4 * certainty / accuracy, 2)); }

std::string shares_text(const TrialError& error) {
    return fmt::format("collision rate {:+.2g} %, pressure {:+.2g} %, each +- {:.1g} %", 100 * error.frequency, 100 * error.pressure,
                       100 * error.error);
}

Choice choose(const Scene& scene, double accuracy, const TrialStart& start, const Communicator& communicator, const Tuning& tuning) {
    const RunSetting all{CollisionRule::all};
    if (accuracy < least_accuracy)
        return {all, fmt::format("collisions = \"all\": an error of {:g} is less than a pilot can see, and this rule makes none", accuracy)};
    const double pairs_per_step = start.frequency * static_cast<double>(scene.n_discs) / 2;
    TrialLength length;
    const double pairs = std::max({collisions_needed(accuracy), fewest_collisions, fewest_per_disc * static_cast<double>(scene.n_discs)});
    length.steps = static_cast<std::int64_t>(std::ceil(pairs / pairs_per_step));
    length.n_looks = 1;
    const Trial exact = run_trial(scene, all, start, length, communicator, tuning);
    const double exact_seconds = exact.wall_seconds / static_cast<double>(length.steps);
    for (std::int64_t k = 1; k <= most_micro_steps; k *= 2) {
        const RunSetting setting{CollisionRule::one, k};
        const Trial trial = run_trial(scene, setting, start, length, communicator, tuning);
        const double seconds = trial.wall_seconds / static_cast<double>(length.steps);
        const TrialError error = error_of(trial, exact);
        if (seconds >= exact_seconds)
            return {all, fmt::format("collisions = \"all\": exact, and no dearer than \"one\" with micro_steps = {} ({:.3g} and {:.3g} s per step), which "
                                     "would make errors of {}", k, exact_seconds, seconds, shares_text(error))};
        if (error.largest() + certainty * error.error <= accuracy)
            return {setting, fmt::format("collisions = \"one\", micro_steps = {}: expect {}; {:.3g} s per step, the exact rule {:.3g}", k,
                                         shares_text(error), seconds, exact_seconds)};
    }
    return {all, "collisions = \"all\": no number of micro-steps is good enough"};
}

} // namespace

double TrialError::largest() const { return std::max(std::fabs(frequency), std::fabs(pressure)); }

/// Pressures differ as the virial's second part does, at most; a count of n has an error of no more than sqrt(n): collisions
/// of hard discs are more regular than chance.
TrialError error_of(const Trial& trial, const Trial& exact) {
    const auto pairs = [](const Trial& t) { return static_cast<double>(std::max<std::uint64_t>(1, t.totals.pair_collisions)); };
    return {trial.averages.collision_frequency.value / exact.averages.collision_frequency.value - 1,
            trial.averages.virial_pressure.value / exact.averages.virial_pressure.value - 1,
            std::sqrt(1 / pairs(trial) + 1 / pairs(exact))};
}

void settle_on(Scene& scene, const RunSetting& setting) {
    scene = with_setting(std::move(scene), setting);
    std::erase_if(scene.overrides, [](const std::string& text) { return text.starts_with("time.accuracy"); });
    scene.overrides.push_back(setting.rule == CollisionRule::all ? "time.collisions=all" : "time.collisions=one");
    scene.overrides.push_back(fmt::format("time.micro_steps={}", setting.micro_steps));
}

void choose_setting(Scene& scene, const std::vector<InputDisc>& discs, bool quiet, const Communicator& communicator,
                    const Tuning& tuning) {
    const TrialStart start = bring_to_equilibrium(scene, discs, approach, communicator, tuning);
    Choice choice = choose(scene, *scene.accuracy, start, communicator, tuning); // all ranks know the same seconds
    if (communicator.is_root() && !quiet)
        fmt::print(stderr, "accuracy {:g}: {}\n", *scene.accuracy, choice.reason);
    settle_on(scene, choice.setting);
}

} // namespace carrom
