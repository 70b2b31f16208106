// SPDX-License-Identifier: BSD-3-Clause
// The time integrals of stress and energy since the last sample. The averages of a run and the
// measured pressures are computed from them.
//
// The integrals of an interval come from exact sums over that interval alone, so their rounding
// errors do not grow with the length of the run. A sample costs two passes over the discs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/stress_sums.hpp"
#include "parallel/communicator.hpp"
#include "simulation/disc_system.hpp"
#include "statistics/motion.hpp"

namespace carrom {

class MotionInterval {
public:
    /// The sums of stress over all ranks since the last sample; `bound` defines their unit.
    struct Pending {
        static constexpr std::size_t n_words = 8;

        double bound = 0;
        std::array<std::uint64_t, n_words> words{};
    };

    /// Starts the interval at the present step. **Collective.**
    MotionInterval(DiscSystem& system, const Communicator& ranks);
    /// Continues an interval from a checkpoint's data; call it before any step. **Collective.**
    MotionInterval(DiscSystem& system, const Communicator& ranks, const Pending& pending,
                   const MotionSample& last);

    /// The last sample. Its integrals contain only the flights up to it that the sums of stress
    /// did not contain at that time.
    const MotionSample& last() const { return last_; }
    /// A sample of the present step. Its integrals minus the integrals of `last` are the integrals
    /// over the interval. **Collective.**
    MotionSample now() const;
    /// Starts the next interval with `now`, a sample of the present step.
    void begin(const MotionSample& now);

    /// The data that a checkpoint stores in addition to `last`. **Collective.**
    Pending pending() const;

private:
    StressSums since_last() const;

    DiscSystem* system_;
    const Communicator* ranks_;
    StressSums last_sums_; ///< this rank's sums of stress at the last sample
    MotionSample last_;
};

} // namespace carrom
