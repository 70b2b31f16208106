// SPDX-License-Identifier: BSD-3-Clause
// The averages of a simulation that a test steps by itself, taken as a run takes them.
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
    /// `simulation` must outlive this. **Collective.**
    Averaging(Scene scene, Simulation& simulation, const Communicator& world)
        : scene_(std::move(scene)), simulation_(simulation), sampler_(scene_, simulation, world) {
        sampler_.sample_if_due();
    }
    Averaging(const TestScene& scene, Simulation& simulation, const Communicator& world)
        : Averaging(scene_of(scene), simulation, world) {}
    Averaging(const Averaging&) = delete;
    Averaging& operator=(const Averaging&) = delete;

    /// What has to act between the steps.
    std::span<StepAction* const> actions() const { return actions_; }
    void advance_to(std::int64_t step) { carrom::advance_to(simulation_, step, actions_); }
    void begin_anew() { sampler_.average_anew(); }
    Averages averages() const { return sampler_.averages(); }

private:
    Scene scene_;
    Simulation& simulation_;
    Sampler sampler_;
    std::array<StepAction*, 1> actions_{&sampler_};
};

} // namespace carrom::test
