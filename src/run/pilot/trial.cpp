// SPDX-License-Identifier: BSD-3-Clause
#include "run/pilot/trial.hpp"

#include <algorithm>
#include <set>

#include <time.h>

#include "core/errors.hpp"
#include "core/stopwatch.hpp"
#include "measure/sampler.hpp"

namespace carrom {

namespace {

constexpr std::int64_t unlimited_steps = std::int64_t{1} << 40;
/// The pilot fails if discs have not collided often enough after this number of steps.
constexpr std::int64_t longest_approach = 1 << 20;

/// CPU seconds of all threads of this process, which other programs on the machine do not affect.
double process_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double collisions_per_disc(const Totals& totals) {
    return 2 * static_cast<double>(totals.pair_collisions) / static_cast<double>(totals.n_discs);
}

} // namespace

std::vector<InputDisc> discs_now(const DiscSystem& system) {
    std::vector<InputDisc> discs;
    const double clock = system.clock(), unit = system.velocity_unit();
    for (const DiscState& disc : system.discs())
        discs.push_back(
            {disc.id, disc.x_at(clock), disc.y_at(clock), disc.vx * unit, disc.vy * unit});
    std::sort(discs.begin(), discs.end(),
              [](const InputDisc& a, const InputDisc& b) { return a.id < b.id; });
    return discs;
}

SceneParameters with_setting(SceneParameters scene, const RunSetting& setting) {
    scene.method = setting.method;
    scene.micro_steps = setting.micro_steps;
    scene.precision = setting.precision;
    scene.arithmetic = setting.arithmetic;
    scene.contraction = setting.contraction;
    scene.accuracy.reset();
    return scene;
}

TrialStart bring_to_equilibrium(const SceneParameters& scene, std::vector<InputDisc> discs,
                                double wanted, const Communicator& communicator,
                                const Tuning& tuning) {
    SceneParameters exact = with_setting(scene, {Method::event_driven});
    exact.steps = unlimited_steps;
    DiscSystem system(exact, std::move(discs), communicator, tuning);
    double done = 0, before = 0;
    std::int64_t from = 0;
    for (std::int64_t step = 1; done < wanted;
         step *= 2) { // doubles, so that the last stretch is half of all steps
        if (step > longest_approach)
            throw InputError(
                {{scene.name, 0,
                  "its discs meet too seldom for errors of collision rates to mean anything"}});
        before = done;
        from = system.step();
        advance_to(system, step);
        done = collisions_per_disc(system.totals());
    }
    TrialStart start;
    start.discs = discs_now(system);
    start.hash = system.totals().hash;
    start.frequency = (done - before) / static_cast<double>(system.step() - from);
    return start;
}

Trial run_trial(const SceneParameters& scene, const RunSetting& setting, const TrialStart& start,
                const TrialLength& length, const Communicator& communicator, const Tuning& tuning) {
    SceneParameters here = with_setting(scene, setting);
    here.steps = length.steps;
    here.measurements.reset();
    DiscSystem system(here, start.discs, communicator, tuning);
    Sampler sampler(here, system, communicator);
    sampler.sample_if_due();
    StepAction* const actions[] = {&sampler};
    std::set<std::int64_t> sampled_steps{length.steps};
    for (int k = 1; k < length.n_samples; ++k)
        sampled_steps.insert(std::max<std::int64_t>(1, length.steps * k / length.n_samples));
    std::set<std::int64_t> stops = sampled_steps;
    if (length.early_step > 0) stops.insert(length.early_step);

    Trial trial;
    trial.steps = length.steps;
    for (const std::int64_t stop : stops) {
        Stopwatch watch;
        const double before = process_seconds();
        advance_to(system, stop, actions);
        trial.core_seconds += process_seconds() - before;
        trial.wall_seconds += watch.lap();
        if (stop == length.early_step) trial.early = discs_now(system);
        if (!sampled_steps.contains(stop)) continue;
        trial.totals = system.totals();
        trial.overlapping_pairs_per_disc += 2 *
                                            static_cast<double>(trial.totals.overlapping_pairs) /
                                            static_cast<double>(trial.totals.n_discs *
                                                                sampled_steps.size());
        trial.deepest_overlap = std::max(trial.deepest_overlap,
                                         trial.totals.deepest_overlap / (2 * scene.radius));
    }
    trial.averages = sampler.averages();
    trial.wall_seconds = communicator.max(trial.wall_seconds);
    std::uint64_t nanoseconds = static_cast<std::uint64_t>(1e9 * trial.core_seconds);
    trial.core_seconds = 1e-9 * static_cast<double>(communicator.sum(nanoseconds));
    return trial;
}

} // namespace carrom
