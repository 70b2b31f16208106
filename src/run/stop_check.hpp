// SPDX-License-Identifier: BSD-3-Clause
// Ends a run before its last step if a condition of `[time.stop]` holds.
//
// Conditions are checked at step 0, and at the end of each step with a sync. The steps of syncs
// depend on the scene alone, and sums are exact. So the run ends at the same step on any number of
// ranks and threads, and also after restarts. The pressure is the mean since the previous check; a
// checkpoint stores the sums of the unfinished interval. Cost of a check: about one pass over the
// discs for each quantity that is compared. Without conditions nothing is done.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measure/pressure_sampler.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/advance.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// The condition that has ended a run.
struct StopReason {
    std::string key; ///< key of the condition
    double limit = 0, value = 0;
    std::int64_t step = 0;
};

/// Text such as "time.stop.kT_below = 0.1: 0.0987".
std::string text_of(const StopReason& reason);

class StopCheck : public StepAction {
public:
    /// Continues from the data of a checkpoint, if there are any. Construct it before any step. All
    /// arguments must outlive this object. **Collective.**
    StopCheck(const SceneParameters& scene, DiscSystem& system, const Communicator& ranks,
              std::span<const std::int64_t> stored);
    StopCheck(const StopCheck&) = delete;
    StopCheck& operator=(const StopCheck&) = delete;

    std::int64_t next_due(std::int64_t step) const override;
    /// Returns false when a condition holds.
    bool act() override;

    /// Why the run ends at the present step; nullopt if it goes on.
    const std::optional<StopReason>& reason() const { return reason_; }
    /// The data for a checkpoint; empty if no condition uses the pressure. **Collective.**
    std::vector<std::int64_t> stored();

private:
    bool is_due(std::int64_t step) const;
    std::int64_t n_syncs(std::int64_t step) const {
        return step * scene_.micro_steps / scene_.sync_every;
    }
    void keep(KeptNumbers& kept);
    void measure_pressure();
    void check();
    void check_counts();
    bool holds(const char* name, const std::optional<double>& below,
               const std::optional<double>& above, double value);
    bool reaches(const char* name, const std::optional<std::int64_t>& limit, std::uint64_t count);

    const SceneParameters& scene_;
    DiscSystem& system_;
    const Communicator& ranks_;
    bool has_conditions_, has_pressure_;
    std::optional<PressureSampler> pressure_;
    double last_pressure_;
    std::int64_t last_check_;
    std::optional<StopReason> reason_;
};

} // namespace carrom
