// SPDX-License-Identifier: BSD-3-Clause
// The averages of a simulation that a test steps by itself, taken in the same way as in a run.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "measure/sampler.hpp"
#include "scene_tools.hpp"
#include "simulation/advance.hpp"

namespace carrom::test {

class Averaging {
public:
    /// `system` must outlive this. **Collective.**
    Averaging(SceneParameters scene, DiscSystem& system, const Communicator& world)
        : scene_(std::move(scene)), system_(system), sampler_(scene_, system, world) {
        sampler_.sample_if_due();
    }
    Averaging(const TestScene& scene, DiscSystem& system, const Communicator& world)
        : Averaging(scene_of(scene), system, world) {}
    Averaging(const Averaging&) = delete;
    Averaging& operator=(const Averaging&) = delete;

    /// The actions between the steps.
    std::span<StepAction* const> actions() const { return actions_; }
    void advance_to(std::int64_t step) { carrom::advance_to(system_, step, actions_); }
    void begin_anew() { sampler_.average_anew(); }
    Averages averages() const { return sampler_.averages(); }

private:
    SceneParameters scene_;
    DiscSystem& system_;
    Sampler sampler_;
    std::array<StepAction*, 1> actions_{&sampler_};
};

} // namespace carrom::test
