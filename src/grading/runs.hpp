// SPDX-License-Identifier: BSD-3-Clause
// The run that a student's output is compared with, and two runs of the same scene with other
// roundings. One begins with changed last bits; the other also uses the course program's formulas.
// Their differences from the first run show how far rounding errors have grown.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/disc_state.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// The expected discs, on rank 0, in order of id.
struct ExpectedDiscs {
    std::vector<DiscState> discs;
    double clock = 0;
    /// For each disc the larger of the difference()s between the first run and the other two
    std::vector<double> spread;
};

class ComparedRuns {
public:
    /// `ranks` must outlive this object. **Collective.**
    ComparedRuns(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                 const Communicator& ranks);

    /// Advances the runs to that step. Rank 0 gets discs, others get an empty list. **Collective.**
    ExpectedDiscs at(std::int64_t step);

private:
    std::vector<DiscState> gather(const DiscSystem& system) const;

    const Communicator& ranks_;
    std::uint64_t n_discs_;
    std::vector<std::unique_ptr<DiscSystem>> runs_;
};

/// A random number from -1 to 1 that is a function of the arguments.
double drawn(std::uint64_t id, std::uint64_t seed);

/// `place` with its last few bits changed at random; 0 stays 0.
double nudged(double place, std::uint64_t id, std::uint64_t seed);

/// The largest difference between the four numbers of two discs; `unit` converts velocities to
/// lengths per step.
double difference(const DiscState& a, double clock_a, const DiscState& b, double clock_b,
                  double unit);

} // namespace carrom
