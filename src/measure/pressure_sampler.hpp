// SPDX-License-Identifier: BSD-3-Clause
// The pressure tensor between two samples, from the time integral of stress since the last one
// (docs/understanding/pressure.md). Price of a sample: two passes over the discs.
#pragma once

#include <optional>
#include <vector>

#include "engine/stress_sums.hpp"
#include "measure/kept_numbers.hpp"
#include "parallel/communicator.hpp"
#include "simulation/simulation.hpp"
#include "statistics/block_averages.hpp"

namespace carrom {

/// The data in a checkpoint.
struct PressureSums {
    double virial_bound = 0;                   ///< the unit of the virial
    std::vector<double> pressures;             ///< by interval: xx, xy, yy, kT and N kT / A
    std::vector<std::uint64_t> pending_virial; ///< since the last sample
    std::vector<double> last_motion;           ///< at the last sample
};

class PressureSampler {
public:
    /// Begins at the present step. **Collective.**
    PressureSampler(Simulation& simulation, const Communicator& ranks, PressureSums& sums);
    /// Goes on from the `sums` of a checkpoint, before any step. **Collective.**
    static PressureSampler going_on(Simulation& simulation, const Communicator& ranks,
                                    PressureSums& sums);

    /// Adds an interval of `steps` steps to `sums`. **Collective.**
    void sample(PressureSums& sums, double steps);
    /// The last sample. Its speeds and counts are unknown after a restart.
    const MotionSample& last() const { return last_; }
    double temperature() const; ///< at the last sample
    /// Time integral of the last interval's stress times area, with all momentum flux; per step.
    const Tensor& last_integral() const { return last_integral_; }
    /// Adds the data since the last sample. **Collective.**
    void store(PressureSums& sums) const;

private:
    PressureSampler(Simulation& simulation, const Communicator& ranks);

    StressSums since_last() const;
    void begin_interval(const MotionSample& now);

    Simulation* simulation_;
    const Communicator* ranks_;
    Tensor last_integral_;
    StressSums last_sums_; ///< on this rank, at the last sample
    MotionSample last_;    ///< its integrals are those of flights since the sync before
};

/// Stores the sums with the data of `sampler`, or restores both. **Collective.**
void keep_pressure(KeptNumbers& kept, PressureSums& sums, std::optional<PressureSampler>& sampler,
                   Simulation& simulation, const Communicator& ranks);

} // namespace carrom
