// SPDX-License-Identifier: BSD-3-Clause
// The run that a student's output is compared with, and two runs of the same scene with
// other roundings: one begins some last bits away, one also has the course program's
// formulas. Their distance from the first run shows how far roundings have grown.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/disc_state.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// Discs on rank 0, by id.
struct ExpectedDiscs {
    std::vector<DiscState> discs;
    double clock = 0;
    std::vector<double> spread; ///< the largest difference of a number in another run, per step
};

class ComparedRuns {
public:
    /// `ranks` must outlive this. **Collective.**
    ComparedRuns(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                 const Communicator& ranks);

    /// Goes on to that step. Rank 0 gets discs, the others nothing. **Collective.**
    ExpectedDiscs at(std::int64_t step);

private:
    std::vector<DiscState> gather(const DiscSystem& system) const;

    const Communicator& ranks_;
    std::uint64_t n_discs_;
    std::vector<std::unique_ptr<DiscSystem>> runs_;
};

/// A number from -1 to 1, the same for the same arguments.
double drawn(std::uint64_t id, std::uint64_t seed);

/// `place` a few of its last bits up or down; 0 stays 0.
double nudged(double place, std::uint64_t id, std::uint64_t seed);

/// The largest difference between the four numbers of two discs; `unit` multiplies velocities.
double difference(const DiscState& a, double clock_a, const DiscState& b, double clock_b,
                  double unit);

} // namespace carrom
