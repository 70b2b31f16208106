// SPDX-License-Identifier: BSD-3-Clause
// The averages of every run. Their errors come from blocks of equal length in time. Averages are
// measured in every run, and have their own sampling times.
//
// A block covers a number of steps. When there are `most_blocks` blocks, they are joined in pairs,
// and later blocks are twice as long. Samples are taken at equal intervals, between syncs as well.
// Between two samples the integrals of stress and energy are exact (engine/stress_sums.hpp),
// and so are counts of collisions. Mean speed and kurtosis are assumed to change linearly. In long
// runs samples are 64 micro-steps or a sync interval apart, whichever is longer; short runs and
// changing energies need closer samples. Cost of a sample: two passes over the discs, 5 ns a disc.
//
// A run that ends at step 1,000,000 or later, and whose energy does not jump at syncs, begins with
// a sample at each step and with blocks of single steps, so that a user who stops early gets error
// estimates. Velocities stay correlated over several collisions, which short blocks cannot show, so
// an error is estimated only after enough collisions. The standard deviation between runs is then
// at most 1.3 times the estimated error.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <carrom/averages.hpp>

#include "measure/measurement.hpp"
#include "measure/motion_interval.hpp"
#include "statistics/blocking.hpp"
#include "statistics/motion.hpp"

namespace carrom {

/// In a run that begins with blocks of single steps, an error estimate needs `fewest_short_blocks`
/// blocks and `fewest_collisions` collisions of all discs together. Averages of speeds and of
/// single pressure components need `fewest_collisions` pair collisions of each disc.
constexpr std::size_t fewest_short_blocks = 16;
constexpr double fewest_collisions = 32;

class BlockAverages : public Measurement {
public:
    explicit BlockAverages(MeasuredRun& run);

    /// Starts the averages anew at the present step.
    void begin() override;
    bool has_begun() const { return interval_.has_value(); }
    /// The first step after `step` at which averages begin or a sample is due.
    std::int64_t next_due(std::int64_t step) const;
    void sample_if_due();
    /// Restarts the interval of integrals at this step, because effects have changed velocities.
    void begin_interval() { interval_->begin(interval_->now()); }
    void sample(const SampledState& state) override;
    void keep(KeptNumbers& kept) override;
    /// No tables, because a run's report and the library use `averages`.
    std::vector<MeasuredTable> tables() const override { return {}; }

    /// Averages up to the present step. **Collective.**
    Averages averages() const;

private:
    /// Numbers of collisions, and integrals over time, with times in steps.
    struct Block {
        double walls = 0, pairs = 0, speed = 0, kurtosis = 0;
        MotionIntegrals motion;

        double steps() const { return motion.steps; }

        Block& operator+=(const Block& other);
        void keep(KeptNumbers& kept);
    };

    bool begins_with_steps() const;
    bool is_short(const Block& whole, double collisions_per_disc) const;
    std::int64_t most_steps_per_sample() const;
    std::int64_t between_syncs(std::int64_t steps) const;
    void add(std::int64_t step, const Block& block);
    Block block_up_to(std::int64_t step, const MotionSample& sample) const;
    void keep_blocks(KeptNumbers& kept);
    bool lost_discs() const;
    /// If a run begins with single-step blocks, an error needs `collisions` pair collisions a disc.
    template <class Value>
    Estimate estimate(const Block& whole, const Value& value, double collisions = 0) const;
    void fill_pressures(Averages& result, const Block& whole) const;
    void fill_counted_pressures(Averages& result, const Block& whole,
                                const MotionSample& sample) const;

    const AveragedSystem& system_;
    /// The interval since the last sample; unset until averages begin
    std::optional<MotionInterval> interval_;
    /// The first step, the first step of the present block, and the step of the last sample
    std::int64_t first_step_ = 0, block_step_ = 0, sample_step_ = 0;
    Block present_;
    std::int64_t steps_per_sample_ = 1, steps_per_block_ = 1;
    std::vector<Block> blocks_;
};

/// Gamma(n + 1/2) / Gamma(n), exact to a few ulp for any n >= 1.
double gamma_ratio(double n);

} // namespace carrom
