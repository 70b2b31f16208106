// SPDX-License-Identifier: BSD-3-Clause
#include "run/run.hpp"

#include <utility>

#include "engine/engine.hpp"
#include "io/checkpoint.hpp"
#include "run/failure_scene.hpp"
#include "run/hard_cases.hpp"
#include "run/memory_check.hpp"
#include "run/pilot/setting_choice.hpp"
#include "stored_scene/stored_scene.hpp"

namespace carrom {

namespace {

/// Returns the scene. If it has `time.accuracy`, a pilot chooses method and micro-steps.
/// **Collective.**
SceneParameters decided(SceneParameters scene, const RunStart& start, const Communicator& ranks,
                        const Tuning& tuning, const Messages& messages) {
    if (scene.accuracy) choose_setting(scene, start.discs, messages, ranks, tuning);
    return scene;
}

/// The system of discs at the run's start, new or from a stored state. **Collective.**
DiscSystem system_from(const SceneParameters& scene, RunStart& start, const Communicator& ranks,
                       const Tuning& tuning) {
    if (start.stored) return DiscSystem(scene, std::move(*start.stored), ranks, tuning);
    return DiscSystem(scene, std::move(start.discs), ranks, tuning);
}

} // namespace

Run::Run(SceneParameters scene, RunStart start, const Communicator& ranks, const Tuning& tuning,
         const Messages& messages)
    : ranks_(ranks), scene_(decided(std::move(scene), start, ranks_, tuning, messages)),
      is_restart_(start.stored.has_value()), n_threads_(tuning.threads),
      system_(system_from(scene_, start, ranks_, tuning)),
      stop_(scene_, system_, ranks_, start.samples.stop), sampler_(scene_, system_, ranks_),
      watch_(scene_, system_, ranks_), heap_warning_(scene_, system_, ranks_, messages) {
    if (const double more = system_.engine().bytes_for_crowds(); more > 0 && !is_restart_)
        check_memory(scene_, ranks_, more); // not earlier, because it depends on the positions
    refuse_hard_cases(scene_, system_, ranks_, messages);
    if (start.counts_images || (scene_.trajectory && scene_.trajectory->has_image)) {
        images_.emplace(system_, ranks_);
        has_earlier_images_ = start.samples.have_images;
        if (has_earlier_images_)
            images_->go_on(start.samples.first_places, &FirstPlace::image_x, &FirstPlace::image_y);
    }
    if (is_restart_) sampler_.go_on(start.samples);
    sampler_.sample_if_due();
    watch_.begin(start.samples.watched);
}

bool Run::advance_to(std::int64_t last_step) {
    if (stop_reason()) return true;
    try {
        const bool is_there = carrom::advance_to(system_, last_step, actions_, &seconds_);
        return is_there || stop_reason();
    } catch (const CheckFailure& failure) {
        throw reported(failure, scene_, ranks_);
    }
}

void Run::commit() {
    for (StepAction* action : actions_) action->commit();
}

StoredSamples Run::stored_samples() {
    StoredSamples samples = sampler_.stored();
    samples.watched = watch_.stored();
    samples.effects = system_.engine().kept_by_effects();
    samples.stop = stop_.stored();
    samples.have_images = images_.has_value();
    if (images_) images_->store(samples.first_places, &FirstPlace::image_x, &FirstPlace::image_y);
    return samples;
}

void Run::write_checkpoint(const std::string& path, Transfers transfers) {
    commit();
    carrom::write_checkpoint(path, header_now(scene_, system_), system_.discs(), ranks_,
                             {n_threads_, transfers == Transfers::collective}, stored_samples(),
                             system_.side_columns());
}

} // namespace carrom
