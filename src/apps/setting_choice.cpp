// SPDX-License-Identifier: BSD-3-Clause
#include "setting_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "carrom/core/errors.hpp"

namespace carrom {

namespace {

constexpr double approach = 10;           ///< collisions of a disc before anything is measured
constexpr double certainty = 2;           ///< standard errors that are added to a measured error
constexpr double most_collisions = 4e6;   ///< of pairs, per trial
constexpr double least_accuracy = 4 * certainty / 2000; ///< what so many can tell, four times: 2000^2 = 4e6
constexpr double fewest_collisions = 2e4; ///< of pairs, and so many times the discs: less is too short to be timed ...
constexpr double fewest_per_disc = 2;
constexpr double long_enough = 2e4;       ///< ... but so many steps, or of discs so many, are not, however few discs meet
constexpr double long_enough_steps = 1e3;
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

/// Enough to see an error of `accuracy`, and to be timed.
std::int64_t trial_steps(double n_discs, double pairs_per_step, double accuracy) {
    const double to_be_timed = std::max(fewest_collisions, fewest_per_disc * n_discs) / pairs_per_step;
    return static_cast<std::int64_t>(std::ceil(std::max(collisions_needed(accuracy) / pairs_per_step,
                                                        std::min(to_be_timed, std::max(long_enough / n_discs, long_enough_steps)))));
}

Choice choose(const Scene& scene, double accuracy, const TrialStart& start, bool quiet, const Communicator& communicator, const Tuning& tuning) {
    const RunSetting all{CollisionRule::all};
    const auto n_discs = static_cast<double>(scene.n_discs);
    TrialLength length;
    length.steps = trial_steps(n_discs, start.frequency * n_discs / 2, accuracy);
    length.n_looks = 1;
    if (communicator.is_root() && !quiet) fmt::print(stderr, "accuracy {:g}: a pilot tries settings, {} steps of each\n", accuracy, length.steps);
    const Trial exact = run_trial(scene, all, start, length, communicator, tuning);
    const double exact_seconds = exact.wall_seconds / static_cast<double>(length.steps);
    bool was_dearer = false; // a number of micro-steps may be dearer than twice as many are
    for (std::int64_t k = 1; k <= most_micro_steps; k *= 2) {
        const RunSetting setting{CollisionRule::one, k};
        const Trial trial = run_trial(scene, setting, start, length, communicator, tuning);
        const double seconds = trial.wall_seconds / static_cast<double>(length.steps);
        const TrialError error = error_of(trial, exact);
        const bool is_dearer = seconds >= exact_seconds;
        if (is_dearer && was_dearer)
            return {all, fmt::format("collisions = \"all\": exact, and no dearer than \"one\" with micro_steps = {} ({:.3g} and {:.3g} s per step), which "
                                     "would make errors of {}", k, exact_seconds, seconds, shares_text(error))};
        was_dearer = is_dearer;
        if (!is_dearer && error.largest() + certainty * error.error <= accuracy)
            return {setting, fmt::format("collisions = \"one\", micro_steps = {}: expect {}; {:.3g} s per step, the exact rule {:.3g}", k,
                                         shares_text(error), seconds, exact_seconds)};
    }
    return {all, "collisions = \"all\": no number of micro-steps is good enough"};
}

/// Throws InputError, with a way out.
TrialStart start_of_pilot(const Scene& scene, const std::vector<InputDisc>& discs, const Communicator& communicator, const Tuning& tuning) {
    try {
        return bring_to_equilibrium(scene, discs, approach, communicator, tuning);
    } catch (const InputError& error) {
        std::vector<Problem> problems = error.problems();
        problems.push_back({scene.name, 0, "so no pilot can measure what 'time.accuracy' is to choose by: give time.collisions and time.micro_steps in its place"});
        throw InputError(std::move(problems));
    }
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
    Choice choice;
    if (*scene.accuracy < least_accuracy) {
        choice = {{CollisionRule::all}, "collisions = \"all\": so small an error is less than a pilot can see, and this rule makes none"};
    } else {
        const TrialStart start = start_of_pilot(scene, discs, communicator, tuning);
        choice = choose(scene, *scene.accuracy, start, quiet, communicator, tuning); // all ranks know the same seconds
    }
    if (communicator.is_root() && !quiet)
        fmt::print(stderr, "accuracy {:g}: {}\n", *scene.accuracy, choice.reason);
    settle_on(scene, choice.setting);
}

} // namespace carrom
