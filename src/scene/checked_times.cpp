// SPDX-License-Identifier: BSD-3-Clause
// Checks of steps, contact times and times of samples that involve more than one key.
#include <algorithm>
#include <bit>
#include <cmath>

#include "scene/limits.hpp"
#include "scene/quantity.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

namespace {

/// The largest number of samples for quantities whose tables grow with time, because these tables
/// are kept in memory and in checkpoints.
constexpr std::int64_t most_samples_of_histories = 100000;

/// Checks that the first sample is within the run, except in runs of 0 steps, which take none.
void check_first_sample(const SceneDraft& draft, std::string_view key, std::int64_t from) {
    const std::int64_t last = draft.scene.steps;
    if (from > last && last > 0)
        draft.refuse({key},
                     fmt::format("'{}' = {} lies beyond the last step, {}", key, from, last));
}

void check_samples(const SceneDraft& draft) {
    check_first_sample(draft, "output.averages_from_step", draft.scene.averages_from);
    if (!draft.scene.measurements) return;
    const MeasurementOutput& output = *draft.scene.measurements;
    check_first_sample(draft, "output.measurements.from_step", output.from_step);
    const std::int64_t steps = draft.scene.steps - output.from_step;
    const std::int64_t n_samples = steps / output.every_steps;
    const std::vector<Quantity>& all = declared_quantities();
    const bool has_history = std::any_of(all.begin(), all.end(), [&output](const Quantity& one) {
        return one.has_history && output.measures(one.name);
    });
    if (!has_history || n_samples <= most_samples_of_histories) return;
    draft.refuse({"output.measurements.every_steps", quantities_key},
                 fmt::format("{} samples of quantities that have a history are more than {}; take "
                             "output.measurements.every_steps = {}",
                             n_samples, most_samples_of_histories,
                             steps / most_samples_of_histories + 1));
}

} // namespace

void limit_contact_time(const SceneDraft& draft, double longest, std::string_view why) {
    constexpr std::string_view key = "effects.contact.contact_time";
    const double time = draft.scene.effects.contact.contact_time;
    if (lose_energy_or_fall(draft.scene.effects) && time > longest)
        draft.refuse({key}, fmt::format("'{}' must be at most {} steps, {}, not {}", key, longest,
                                        why, time));
}

void check_times(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    if (scene.steps > largest_steps / scene.micro_steps)
        draft.refuse({"time.steps"}, fmt::format("{} steps of {} micro-steps are more than 2^53 "
                                                 "micro-steps",
                                                 scene.steps, scene.micro_steps));
    if (!std::has_single_bit(static_cast<std::uint64_t>(scene.micro_steps)))
        scene.warnings.push_back(fmt::format(
            "time.micro_steps = {} is not a power of two: velocities are rounded when they are "
            "divided by it",
            scene.micro_steps));
    if (scene.precision == Precision::single && scene.sync_every > longest_single_sync)
        draft.refuse({"time.precision"},
                     fmt::format("precision = \"single\" counts micro-steps up to {} between "
                                 "syncs; 'time.sync_every' is {}",
                                 longest_single_sync, scene.sync_every));
    check_samples(draft);
    check_times_of_quantities(draft);
}

} // namespace carrom
