// SPDX-License-Identifier: BSD-3-Clause
// The pressure tensor between two samples: the virial of all collisions of pairs since the last
// one, and the mean of the kinetic parts at both (docs/understanding/pressure.md). Price of a
// sample: two passes over the discs.
#pragma once

#include <optional>
#include <vector>

#include "engine/pair_virial.hpp"
#include "measure/sample_sums.hpp"
#include "parallel/communicator.hpp"
#include "simulation/simulation.hpp"
#include "statistics/block_averages.hpp"

namespace carrom {

class PressureSampler {
public:
    /// Begins at the present step. **Collective.**
    PressureSampler(Simulation& simulation, const Communicator& ranks, SampleSums& sums);
    /// Goes on with what `sums` have of a checkpoint, before any step. **Collective.**
    static PressureSampler going_on(Simulation& simulation, const Communicator& ranks,
                                    SampleSums& sums);

    /// Adds an interval, of so many steps, to `sums`. **Collective.**
    void sample(SampleSums& sums, double steps);
    /// Of the last sample. Without collisions where sampling goes on from a checkpoint.
    const MotionNow& last() const { return last_; }
    /// Fills in what has happened since the last sample. **Collective.**
    void store(SampleSums& sums) const;

private:
    PressureSampler(Simulation& simulation, const Communicator& ranks);

    PairVirial since_last() const;

    Simulation* simulation_;
    const Communicator* ranks_;
    PairVirial last_virial_; ///< of this rank, at the last sample
    MotionNow last_;         ///< at the last sample
};

} // namespace carrom
