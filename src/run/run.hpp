// SPDX-License-Identifier: BSD-3-Clause
// A run of a scene: its simulation, its measurements, and the actions between steps.
//
// The program and the library create and advance runs in the same way. They differ in the actions
// that they add: the program adds lines of text, recordings and checkpoints; the library adds
// checkpoints on request.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/tuning.hpp"
#include "measure/image_counts.hpp"
#include "measure/order_watch.hpp"
#include "measure/sampler.hpp"
#include "parallel/communicator.hpp"
#include "run/heap_warning.hpp"
#include "run/messages.hpp"
#include "run/start/run_start.hpp"
#include "run/stop_check.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/advance.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

class Run {
public:
    /// Begins at step 0, or continues from a stored state. A pilot chooses method and micro-steps
    /// if the scene has `time.accuracy`. Throws InputError on every rank, for example if
    /// discs are too fast. Takes the first sample if it is due. **Collective.**
    Run(SceneParameters scene, RunStart start, const Communicator& ranks, const Tuning& tuning,
        const Messages& messages = {});
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;

    const SceneParameters& scene() const { return scene_; } ///< includes a pilot's choice
    const Communicator& ranks() const { return ranks_; }
    int n_threads() const { return n_threads_; } ///< threads of this rank
    bool is_restart() const { return is_restart_; }
    DiscSystem& system() { return system_; }
    const DiscSystem& system() const { return system_; }
    std::int64_t step() const { return system_.step(); }

    /// The averages and the scene's measurements.
    Sampler& sampler() { return sampler_; }
    const Sampler& sampler() const { return sampler_; }
    /// Watches order and energy, which may drift while the averages seem constant.
    const OrderWatch& watch() const { return watch_; }
    /// Counts of crossed box lengths, if a trajectory has images or the start requires counts; null
    /// otherwise. They continue from a checkpoint that contains counts.
    ImageCounts* images() { return images_ ? &*images_ : nullptr; }
    bool has_earlier_images() const { return has_earlier_images_; }

    /// From now on calls `action` between steps, after the actions that were added before. The
    /// action must outlive the run's steps.
    void add(StepAction& action) { actions_.push_back(&action); }
    /// The step at which the run ends: the scene's last one, or the present one if a condition of
    /// `[time.stop]` holds.
    std::int64_t last_step() const { return stop_.reason() ? stop_.reason()->step : scene_.steps; }
    const std::optional<StopReason>& stop_reason() const { return stop_.reason(); }
    /// Advances to the end of `last_step`, or to an earlier end of the run. Returns false if an
    /// action ended the run without a StopReason. If a check of `check_every_step` fails, the discs
    /// around the error are written as a scene. **Collective.**
    bool advance_to(std::int64_t last_step);
    const StretchSeconds& seconds() const { return seconds_; }

    /// Makes everything permanent that the actions have written so far. **Collective.**
    void commit();
    /// The data that a checkpoint stores in addition to the state. **Collective.**
    StoredSamples stored_samples();
    /// Writes the present state as a whole file or not at all. If it fails every rank
    /// throws, and an older file of that name is unchanged. **Collective.**
    void write_checkpoint(const std::string& path, Transfers transfers = Transfers::independent);

private:
    const Communicator ranks_;
    SceneParameters scene_;
    bool is_restart_, has_earlier_images_ = false;
    int n_threads_;
    DiscSystem system_;
    std::optional<ImageCounts> images_;
    StopCheck stop_; ///< constructed before the sampler, because it may change the unit of stress
    Sampler sampler_;
    OrderWatch watch_;
    HeapWarning heap_warning_;
    /// The sampler is the first action, so that all others find the sample of the present step.
    std::vector<StepAction*> actions_{&sampler_, &watch_, &heap_warning_, &stop_};
    StretchSeconds seconds_;
};

} // namespace carrom
