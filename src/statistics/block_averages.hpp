// SPDX-License-Identifier: BSD-3-Clause
// The history of a run in blocks of equal length in time, to show how much its averages can be
// trusted.
//
// A block is a number of steps: a quarter of a short run, a sync interval of a long one. When
// there are `most_blocks`, each two become one, and blocks are twice as long from then on. The
// discs are looked at where a sync has ended and where a block ends: places that depend on the
// scene alone. What is known then is taken to change evenly in between. Price of a look: two passes
// over the discs, some five nanoseconds a disc.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <carrom/averages.hpp>
#include <carrom/box.hpp>

#include "core/disc.hpp"
#include "dynamics/species.hpp"
#include "engine/pair_virial.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// Of two vectors' products, the same both ways.
struct Tensor {
    double xx = 0, xy = 0, yy = 0;

    Tensor& operator+=(const Tensor& other);
    friend Tensor operator*(double factor, const Tensor& t) {
        return {factor * t.xx, factor * t.xy, factor * t.yy};
    }
};

/// What is known of all discs at one time; speeds are of those that have not left the box. They are
/// in units of `speed_unit`, a power of two, per micro-step.
struct Look {
    std::uint64_t wall_collisions = 0,
                  pair_collisions = 0; ///< since the scene's start; a pair counts once
    double speed_unit = 1;
    double mean_speed = 0, mean_square = 0, mean_fourth = 0; ///< per disc
    double n_discs = 0;                                      ///< in the box
    double mass = 0, momentum_x = 0, momentum_y = 0;         ///< of all of them
    Tensor motion;                                           ///< sum of m v v
    Tensor virial;   ///< of pairs since the process began; mass length^2 per micro-step
    double area = 0; ///< of the box
};

/// All but virial and area. The same bits for every machine shape: each term is rounded to 2^-62 of
/// N times the largest speed. `species_table`: null for masses of 1. **Collective.**
Look look_at(std::span<const Disc> own, const SpeciesTable* species_table, double heaviest,
             std::uint64_t n_discs, int n_threads, const Communicator& communicator);

/// Over all ranks. **Collective.**
Tensor sum_of(const PairVirial& virial, const Communicator& communicator);

/// What the kinetic part of the pressure follows from.
struct MotionNow {
    Tensor flux; ///< the sum of m v v per step, as BlockAverages::motion_of has it
    double n_discs = 0, area = 0;
    std::uint64_t pair_collisions = 0; ///< since the scene's start
};

/// The scene's constants that averages need.
struct AveragedSystem {
    Box box;
    double n_discs = 0, radius = 0;
    double velocity_unit = 1; ///< turns stored velocities into those per step
    std::int64_t micro_steps = 1, sync_every = 1;
    bool is_plain = true;    ///< elastic discs between elastic walls; else pressures from counts
                             ///< are NaN
    bool keeps_discs = true; ///< else collisions per disc are NaN
    bool is_periodic_x = false, is_periodic_y = false; ///< a drift along it is no temperature
    std::int64_t last_step = 0;                        ///< that the run is to come to
};

class BlockAverages {
public:
    explicit BlockAverages(const AveragedSystem& system) : system_(system) {}

    /// Begins anew at `step`.
    void begin(std::int64_t step, const Look& look);
    bool has_begun() const { return has_begun_; }

    /// The next step at which a block ends.
    std::int64_t block_end() const { return block_step_ + steps_per_block_; }
    /// Whether to look at `step`; asked at every step that a sync or a block has ended in or since
    /// the step before.
    bool is_due(std::int64_t step) const;
    void add(std::int64_t step, const Look& look);

    /// The sum of m v v per step, without a drift along periodic sides. Its mean is N kT along each
    /// axis: a momentum that is conserved takes one of N degrees of freedom away.
    Tensor motion_of(const Look& look) const;

    /// All that it knows, as plain words, for a checkpoint. Good for the same scene alone.
    std::vector<std::int64_t> words() const;
    /// Goes on with such words; false, and nothing has changed, where they are none.
    bool set_words(std::span<const std::int64_t> words);

    /// Averages up to `step`.
    Averages averages(std::int64_t step, const Look& look) const;

private:
    static constexpr std::size_t most_blocks = 64;

    /// Integrals over time.
    struct Block {
        double steps = 0, walls = 0, pairs = 0;
        double speed = 0, kurtosis = 0, area = 0, n_discs = 0;
        Tensor motion, virial;

        Block& operator+=(const Block& other);
    };

    std::int64_t syncs_before(std::int64_t step) const {
        return step * system_.micro_steps / system_.sync_every;
    }
    Block block_between(std::int64_t step, const Look& before, std::int64_t now,
                        const Look& look) const;
    template <class Value> Estimate estimate(const Block& whole, const Value& value) const;
    void fill_pressures(Averages& result, const Block& whole) const;
    void fill_counted_pressures(Averages& result, const Block& whole, const Look& look) const;

    AveragedSystem system_;
    bool has_begun_ = false;
    std::int64_t first_step_ = 0, block_step_ = 0, look_step_ = 0; ///< where it began; where the
                                                                   ///< present block did; the last
                                                                   ///< look
    Look last_;
    Block present_;
    std::int64_t steps_per_block_ = 1;
    std::vector<Block> blocks_;
};

/// Gamma(n + 1/2) / Gamma(n), to a few ulp for any n >= 1.
double gamma_ratio(double n);

/// The standard error of the mean of terms that follow each other in time. Terms may hang together
/// over more than one block: the largest of the errors from single blocks and from joined ones
/// (Flyvbjerg and Petersen 1989); NaN where there are fewer than `fewest_blocks`.
constexpr std::size_t fewest_blocks = 4;
double standard_error(std::vector<double> terms);

} // namespace carrom
