// SPDX-License-Identifier: BSD-3-Clause
// The history of a run in blocks of equal length in time. It shows how far the run's
// averages can be trusted.
//
// A block is a number of steps. When there are `most_blocks`, each two become one, and blocks are
// twice as long from then on. The discs are sampled at fixed steps, which do not depend on syncs.
// Between two samples the integrals of stress and energy are exact (engine/stress_sums.hpp), and
// so are counts of collisions; mean speed and kurtosis are taken to change evenly. Samples are 64
// micro-steps apart in long runs, closer in runs that are short for an error or whose energy
// changes. Price of a sample: two passes over the discs, some five nanoseconds a disc.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <carrom/averages.hpp>

#include "statistics/blocking.hpp"
#include "statistics/motion.hpp"

namespace carrom {

class BlockAverages {
public:
    explicit BlockAverages(const AveragedSystem& system) : system_(system) {}

    /// Begins anew at `step`.
    void begin(std::int64_t step, const MotionSample& sample);
    bool has_begun() const { return has_begun_; }

    /// The step of the next sample.
    std::int64_t next_sample() const { return sample_step_ + steps_per_sample_; }
    bool is_due(std::int64_t step) const { return step >= next_sample(); }
    void add(std::int64_t step, const MotionSample& sample);

    const AveragedSystem& system() const { return system_; }

    /// The whole history as plain words, for a checkpoint. They are good for the same scene only.
    std::vector<std::int64_t> words() const;
    /// Goes on from such words. Returns false, with nothing changed, if they are not valid.
    bool set_words(std::span<const std::int64_t> words);

    /// Averages up to `step`.
    Averages averages(std::int64_t step, const MotionSample& sample) const;

private:
    /// Integrals over time.
    struct Block {
        double walls = 0, pairs = 0, speed = 0, kurtosis = 0;
        MotionIntegrals motion;

        double steps() const { return motion.steps; }

        Block& operator+=(const Block& other);
    };

    std::int64_t most_steps_per_sample() const;
    Block block_between(std::int64_t step, const MotionSample& before, std::int64_t now,
                        const MotionSample& sample) const;
    template <class Value> Estimate estimate(const Block& whole, const Value& value) const;
    void fill_pressures(Averages& result, const Block& whole) const;
    void fill_counted_pressures(Averages& result, const Block& whole,
                                const MotionSample& sample) const;

    AveragedSystem system_;
    bool has_begun_ = false;
    std::int64_t first_step_ = 0, block_step_ = 0, sample_step_ = 0; ///< the beginning, the
                                                                     ///< beginning of the present
                                                                     ///< block, and the last sample
    MotionSample last_;
    Block present_;
    std::int64_t steps_per_sample_ = 1, steps_per_block_ = 1;
    std::vector<Block> blocks_;
};

/// Gamma(n + 1/2) / Gamma(n), to a few ulp for any n >= 1.
double gamma_ratio(double n);

} // namespace carrom
