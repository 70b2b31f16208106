// SPDX-License-Identifier: BSD-3-Clause
#include "run/pilot/setting_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/errors.hpp"

namespace carrom {

namespace {

constexpr double approach = 10; ///< mean number of collisions of a disc before the trials begin
constexpr double certainty = 2; ///< number of standard errors that are added to a measured error
constexpr double most_collisions = 4e6; ///< largest result of collisions_needed
/// The smallest error that 4e6 collisions can resolve, because sqrt(4e6) is 2000
constexpr double least_accuracy = 4 * certainty / 2000;
/// The least mean number of collisions of a disc in a trial; errors in dense gases appear late
constexpr double per_disc = 100;
/// A trial can be timed if it has this many pair collisions, or else these numbers of disc-steps
/// and steps.
constexpr double fewest_collisions = 2e4;
constexpr double long_enough = 2e4;
constexpr double long_enough_steps = 1e3;
/// Seconds after which a setting may be dropped before its trial ends, and after which it may count
/// as slow. The latter is longer, because the start of a trial takes time, too.
constexpr double long_trial = 0.02, timed_enough = 0.2;
/// Overlaps are not steady if they grow by more than this factor between stretches
constexpr double steady = 1.2;
/// The lengths of a trial's stretches, in sixteenths of the trial
constexpr std::array<int, 5> stretches = {1, 1, 2, 4, 8};
constexpr std::int64_t most_micro_steps = 1 << 20;

struct Choice {
    RunSetting setting;
    std::string reason;
};

/// The number of pair collisions at which an error of `accuracy` exceeds the noise of two trials.
double collisions_needed(double accuracy) {
    return std::min(most_collisions, std::pow(4 * certainty / accuracy, 2));
}

std::string shares_text(const TrialError& error) {
    return fmt::format("collision rate {:+.2g} %, pressure {:+.2g} %, each +- {:.1g} %",
                       100 * error.frequency, 100 * error.pressure, 100 * error.error);
}

/// The number of steps in a sixteenth of a trial. The trial's last half must be long enough to show
/// an error of `accuracy`, and the whole trial long enough to be timed.
std::int64_t sixteenth_of_trial(double n_discs, double pairs_per_step, double accuracy) {
    const double to_be_timed = std::min(fewest_collisions / pairs_per_step,
                                        std::max(long_enough / n_discs, long_enough_steps));
    const double to_be_seen = std::max(per_disc * n_discs / 2, 2 * collisions_needed(accuracy)) /
                              pairs_per_step;
    return static_cast<std::int64_t>(std::ceil(std::max(to_be_timed, to_be_seen) / 16));
}

/// The settings that all trials share.
struct Pilot {
    const SceneParameters& scene;
    const TrialStart& start;
    std::int64_t sixteenth; ///< a sixteenth of a trial, in steps
    const Communicator& communicator;
    const Tuning& tuning;
};

/// Runs a trial's next stretch from the discs in `at`, and replaces them by the discs at its end.
Trial run_stretch(const Pilot& pilot, const RunSetting& setting, std::size_t stretch,
                  TrialStart& at) {
    TrialLength length;
    length.steps = length.early_step = pilot.sixteenth * stretches[stretch];
    length.n_samples = 4;
    Trial trial = run_trial(pilot.scene, setting, at, length, pilot.communicator, pilot.tuning);
    at.discs = std::move(trial.early);
    return trial;
}

std::vector<Trial> run_event_driven(const Pilot& pilot) {
    TrialStart at = pilot.start;
    std::vector<Trial> trials;
    for (std::size_t k = 0; k < stretches.size(); ++k)
        trials.push_back(run_stretch(pilot, {Method::event_driven}, k, at));
    return trials;
}

/// The results of a setting's trial so far.
struct Experience {
    TrialError error;                          ///< error in the last stretch so far
    double seconds = 0, reference_seconds = 0; ///< times of the trial and of the exact run so far
    /// Whether the trial ran to its end; false if it was stopped because of its error
    bool is_whole = false;
    bool grows = false; ///< whether overlaps keep growing, so that errors grow, too
};

/// Whether overlaps increase by more than chance explains.
bool are_growing(const Trial& before, const Trial& after) {
    const auto n_pairs = [](const Trial& trial) {
        return trial.overlapping_pairs_per_disc * static_cast<double>(trial.totals.n_discs) / 2;
    };
    return n_pairs(after) > steady * n_pairs(before) + 3 * std::sqrt(n_pairs(before) + 1);
}

Experience try_setting(const Pilot& pilot, const RunSetting& setting,
                       const std::vector<Trial>& exact, double accuracy) {
    Experience found;
    TrialStart at = pilot.start;
    Trial before;
    for (std::size_t k = 0; k < stretches.size(); ++k) {
        const Trial trial = run_stretch(pilot, setting, k, at);
        found.seconds += trial.wall_seconds; // equal on all ranks, so all stop together
        found.reference_seconds += exact[k].wall_seconds;
        found.error = error_of(trial, exact[k]);
        found.grows = k > 0 && are_growing(before, trial);
        found.is_whole = k + 1 == stretches.size();
        if (found.seconds > long_trial &&
            found.error.largest() - certainty * found.error.error > accuracy)
            break;
        before = trial;
        before.early.clear();
    }
    return found;
}

Choice choose(const Pilot& pilot, double accuracy) {
    const RunSetting all{Method::event_driven};
    const std::vector<Trial> exact = run_event_driven(pilot);
    double steps = 0;
    for (const Trial& trial : exact) steps += static_cast<double>(trial.steps);
    bool was_slower = false; // two slow K are needed, because K may be slower than 2 K
    for (std::int64_t k = 1; k <= most_micro_steps; k *= 2) {
        const RunSetting setting{Method::time_stepped, k};
        const Experience found = try_setting(pilot, setting, exact, accuracy);
        const bool is_slower = found.seconds >= found.reference_seconds &&
                               (found.is_whole || found.seconds > timed_enough);
        if (is_slower && was_slower)
            return {
                all,
                fmt::format("method = \"event-driven\": exact, and no slower than \"time-stepped\" "
                            "with micro_steps = {} ({:.2g} times its cost), which would make "
                            "errors of {}{}",
                            k, found.seconds / found.reference_seconds, shares_text(found.error),
                            found.grows ? " and growing" : "")};
        was_slower = is_slower;
        if (!is_slower && found.is_whole && !found.grows &&
            found.error.largest() + certainty * found.error.error <= accuracy)
            return {setting, fmt::format("method = \"time-stepped\", micro_steps = {}: expect {}; "
                                         "{:.3g} s per step, the event-driven method {:.3g}",
                                         k, shares_text(found.error), found.seconds / steps,
                                         found.reference_seconds / steps)};
    }
    return {all, "method = \"event-driven\": no number of micro-steps is good enough"};
}

/// Brings the discs to equilibrium. Adds advice to an InputError. **Collective.**
TrialStart start_of_pilot(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                          const Communicator& communicator, const Tuning& tuning) {
    try {
        return bring_to_equilibrium(scene, discs, approach, communicator, tuning);
    } catch (const InputError& error) {
        std::vector<Problem> problems = error.problems();
        problems.push_back({scene.name, 0,
                            "so no pilot can measure what 'time.accuracy' is to choose by: give "
                            "time.method and time.micro_steps in its place"});
        throw InputError(std::move(problems));
    }
}

} // namespace

double TrialError::largest() const { return std::max(std::fabs(frequency), std::fabs(pressure)); }

/// The statistical error is estimated from the number n of collisions, because the relative error
/// of a pressure is not larger. The error of n is at most sqrt(n), because collisions of hard discs
/// are more regular than independent events.
TrialError error_of(const Trial& trial, const Trial& exact) {
    const auto pairs = [](const Trial& t) {
        return static_cast<double>(std::max<std::uint64_t>(1, t.totals.pair_collisions));
    };
    return {trial.averages.collision_frequency.value / exact.averages.collision_frequency.value - 1,
            trial.averages.virial_pressure.value / exact.averages.virial_pressure.value - 1,
            std::sqrt(1 / pairs(trial) + 1 / pairs(exact))};
}

void decide_on(SceneParameters& scene, const RunSetting& setting) {
    scene = with_setting(std::move(scene), setting);
    std::erase_if(scene.overrides,
                  [](const std::string& text) { return text.starts_with("time.accuracy"); });
    scene.overrides.push_back(setting.method == Method::event_driven ? "time.method=event-driven"
                                                                     : "time.method=time-stepped");
    scene.overrides.push_back(fmt::format("time.micro_steps={}", setting.micro_steps));
}

void choose_setting(SceneParameters& scene, const std::vector<InputDisc>& discs,
                    const Messages& messages, const Communicator& communicator,
                    const Tuning& tuning) {
    Choice choice;
    if (*scene.accuracy < least_accuracy) {
        choice = {{Method::event_driven},
                  "method = \"event-driven\": so small an error is less than a pilot can see, and "
                  "this rule makes none"};
    } else {
        const TrialStart start = start_of_pilot(scene, discs, communicator, tuning);
        const auto n_discs = static_cast<double>(scene.n_discs);
        const Pilot pilot{
            scene, start,
            sixteenth_of_trial(n_discs, start.frequency * n_discs / 2, *scene.accuracy),
            communicator, tuning};
        messages.note("accuracy {:g}: a pilot tries settings, each for up to {} steps\n",
                      *scene.accuracy, 16 * pilot.sixteenth);
        choice = choose(pilot, *scene.accuracy);
    }
    messages.note("accuracy {:g}: {}\n", *scene.accuracy, choice.reason);
    decide_on(scene, choice.setting);
}

} // namespace carrom
