// SPDX-License-Identifier: BSD-3-Clause
#include "measure/sampler.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "engine/engine.hpp"
#include "engine/state_sums.hpp"
#include "scene/effects/effect.hpp"

namespace carrom {

namespace {

constexpr std::int64_t format = 3;

/// The measurements of a scene without [output.measurements].
const MeasurementOutput nothing;

} // namespace

Sampler::Sampler(const SceneParameters& scene, DiscSystem& system, const Communicator& ranks)
    : run_{scene, scene.measurements ? *scene.measurements : nothing, system, ranks},
      averages_(run_) {
    for (const MeasuredQuantity& quantity : measured_quantities()) {
        if (!run_.output.measures(quantity.declared.name)) continue;
        measurements_.push_back(quantity.make(run_, measurements_));
        names_.emplace_back(quantity.declared.name);
    }
    if (does_energy_jump(scene.effects))
        system.engine().call_before_effects([this] { sample_before_effects(); });
}

Sampler::~Sampler() {
    if (does_energy_jump(run_.scene.effects)) run_.system.engine().call_before_effects({});
}

/// Stores the settings on which sums depend, or compares them with stored ones. If they differ, the
/// stored sums cannot be used. Each measurement also compares its own settings.
void Sampler::keep_settings(KeptNumbers& kept) const {
    kept.same(format);
    kept.same(names_);
    kept.same(run_.output.every_steps);
    kept.same(run_.output.from_step);
}

void Sampler::keep_counts(KeptNumbers& kept) const {
    SampleCounts& counts = run_.counts;
    kept(counts.first_step), kept(counts.last_step), kept(counts.n_samples), kept(counts.n_discs),
        kept(counts.area);
}

void Sampler::go_on(const StoredSamples& stored) {
    if (!stored.averages.empty()) {
        KeptNumbers kept(stored.averages);
        averages_.keep(kept);
    }
    if (run_.scene.measurements) go_on_measuring(stored);
}

void Sampler::go_on_measuring(const StoredSamples& stored) {
    const std::int64_t step = run_.system.step();
    if (stored.sums.empty() || step <= run_.output.from_step) return;
    KeptNumbers kept(stored.sums);
    keep_settings(kept);
    StoredSamples asked; // its flags show which numbers per disc these quantities store
    if (kept.is_right()) keep_counts(kept);
    for (const auto& measurement : measurements_) {
        if (!kept.is_right()) break;
        kept.part([&](KeptNumbers& its) { measurement->keep(its); });
    }
    for (const auto& measurement : measurements_) measurement->store_discs(asked);
    if (!kept.is_right() || !kept.is_at_end() ||
        stored.have_first_places != asked.have_first_places ||
        stored.have_lengths != asked.have_lengths ||
        stored.have_velocities != asked.have_velocities)
        throw InputError(
            {{"[output.measurements]", 0,
              fmt::format("the checkpoint's measurements are of other keys: keep those, or begin "
                          "anew with output.measurements.from_step = {}",
                          step)}});
    for (const auto& measurement : measurements_) measurement->restore_discs(stored);
    has_begun_ = true;
}

std::int64_t Sampler::next_due(std::int64_t step) const {
    const std::int64_t average = averages_.next_due(step);
    if (!run_.scene.measurements) return average;
    const std::int64_t first = run_.counts.first_step, every = run_.output.every_steps;
    if (!has_begun_) return std::min(average, std::max(step + 1, run_.output.from_step));
    return std::min(average, first + ((step - first) / every + 1) * every);
}

void Sampler::sample_if_due() {
    if (averaged_before_ == run_.system.step())
        averages_.begin_interval();
    else
        averages_.sample_if_due();
    averaged_before_ = -1;
    if (run_.scene.measurements) measure_if_due();
}

/// Takes samples at a sync before effects act, because the energy then jumps: its values before and
/// after the effects are different.
void Sampler::sample_before_effects() {
    const std::int64_t step = run_.system.step();
    if (run_.system.micro_steps_done() % run_.scene.micro_steps != 0) return;
    if (averages_.has_begun() && averages_.next_due(step - 1) <= step) {
        averages_.sample_if_due();
        averaged_before_ = step;
    }
    if (!is_due(step)) return;
    end_intervals();
    ended_before_ = step;
    if (!is_turn_before_effects()) return;
    DiscStates kept;
    const SampledState state = state_now(kept);
    for (const auto& measurement : measurements_)
        if (measurement->has_velocities()) measurement->sample(state);
    sampled_before_ = step;
}

void Sampler::end_intervals() {
    for (const auto& measurement : measurements_) measurement->end_interval();
}

/// Whether velocities at this sync are sampled before effects; such samples and samples after
/// effects alternate. Only the number of samples determines this, so that it is the same after a
/// restart.
bool Sampler::is_turn_before_effects() const {
    const std::int64_t apart = run_.output.every_steps * run_.scene.micro_steps,
                       samples_between = run_.scene.sync_every /
                                         std::gcd(apart, run_.scene.sync_every);
    return static_cast<std::int64_t>(run_.counts.n_samples) / samples_between % 2 == 1;
}

bool Sampler::is_due(std::int64_t step) const {
    return has_begun_ && step != run_.counts.last_step &&
           (step - run_.counts.first_step) % run_.output.every_steps == 0;
}

void Sampler::measure_if_due() {
    const std::int64_t step = run_.system.step();
    if (!has_begun_ && step >= run_.output.from_step) {
        run_.counts.first_step = step;
        for (const auto& measurement : measurements_) measurement->begin();
        has_begun_ = true;
    }
    if (is_due(step)) sample(step);
}

SampledState Sampler::state_now(DiscStates& kept) const {
    const SceneParameters& scene = run_.scene;
    SampledState state;
    state.shown = run_.system.shown();
    state.n_discs = run_.ranks.sum(std::uint64_t{state.shown.size()});
    state.box = run_.system.box();
    state.is_first = run_.counts.n_samples == 0;
    state.inside = discs_in_box(state.shown, scene.effects, state.box, run_.system.clock(), kept);
    return state;
}

void Sampler::sample(std::int64_t step) {
    const bool is_sampled_before = sampled_before_ == step;
    DiscStates kept;
    SampledState state = state_now(kept);
    state.follows_effects = ended_before_ == step;
    if (!state.follows_effects && !state.is_first) end_intervals();
    run_.counts.n_discs += run_.ranks.sum(std::uint64_t{state.inside.size()});
    run_.counts.area += (state.box.x_high - state.box.x_low) * (state.box.y_high - state.box.y_low);
    for (const bool moves_discs : {false, true})
        for (const auto& measurement : measurements_)
            if (measurement->moves_discs() == moves_discs &&
                !(is_sampled_before && measurement->has_velocities()))
                measurement->sample(state);
    ++run_.counts.n_samples;
    run_.counts.last_step = step;
}

StoredSamples Sampler::stored() const {
    StoredSamples stored;
    if (averages_.has_begun()) {
        KeptNumbers kept;
        averages_.keep(kept);
        stored.averages = kept.take_words();
    }
    if (!has_begun_) return stored;
    KeptNumbers kept;
    keep_settings(kept);
    keep_counts(kept);
    for (const auto& measurement : measurements_) {
        kept.part([&](KeptNumbers& its) { measurement->keep(its); });
        measurement->store_discs(stored);
    }
    stored.sums = kept.take_words();
    return stored;
}

std::vector<MeasuredTable> Sampler::tables() const {
    std::vector<MeasuredTable> all;
    const SampleCounts& counts = run_.counts;
    if (!has_begun_ || counts.n_samples == 0) return all;
    const std::string what = fmt::format("{} samples, steps {} to {}, one every {}",
                                         counts.n_samples, counts.first_step, counts.last_step,
                                         run_.output.every_steps);
    for (const auto& measurement : measurements_) {
        for (MeasuredTable& table : measurement->tables()) {
            table.remarks.insert(table.remarks.begin(), what);
            all.push_back(std::move(table));
        }
    }
    for (MeasuredTable& table : rows_from(0)) all.push_back(std::move(table));
    for (const MeasuredTable& table : all)
        ensure(is_name_of_table(table.name), "a quantity does not declare the name of a table");
    return all;
}

std::vector<std::string> Sampler::doubts() const {
    std::vector<std::string> all;
    for (const auto& measurement : measurements_)
        if (std::string one = measurement->doubt(); !one.empty()) all.push_back(std::move(one));
    return all;
}

std::vector<MeasuredTable> Sampler::rows_from(std::size_t first) const {
    std::vector<MeasuredTable> all;
    if (!has_begun_ || run_.counts.n_samples <= first) return all;
    for (const auto& measurement : measurements_)
        if (std::optional<MeasuredTable> table = measurement->rows_from(first))
            all.push_back(std::move(*table));
    return all;
}

} // namespace carrom
