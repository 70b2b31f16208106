// SPDX-License-Identifier: BSD-3-Clause
// The history of a run in blocks of about equal length, to show how much its averages can be
// trusted.
//
// A block ends where a sync has ended: a place that depends on the scene alone. When there are
// `most_blocks`, each two become one and blocks twice as long from then on: a run of any length is
// looked at a few hundred times. Price of a look: one pass over the discs, two to three nanoseconds
// a disc.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <carrom/averages.hpp>

#include "core/disc.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// What is known of all discs at one time; speeds are of those that have not left the box. They are
/// in units of `speed_unit`, a power of two, per micro-step.
struct Look {
    std::uint64_t wall_collisions = 0,
                  pair_collisions = 0; ///< since the scene's start; a pair counts once
    double speed_unit = 1;
    double mean_speed = 0, mean_square = 0, mean_fourth = 0; ///< per disc
};

/// The same bits for every machine shape: each term is rounded to 2^-62 of N times the largest
/// speed. **Collective.**
Look look_at(std::span<const Disc> own, std::uint64_t n_discs, int n_threads,
             const Communicator& communicator);

/// The scene's constants that averages need.
struct AveragedSystem {
    double n_discs = 0, box_size = 0, radius = 0;
    double velocity_unit = 1; ///< turns stored velocities into those per step
    std::int64_t micro_steps = 1, sync_every = 1;
    bool is_plain =
        true; ///< elastic discs between elastic walls; else pressures are NaN, and speeds may drift
    bool keeps_discs = true; ///< else collisions per disc are NaN
};

class BlockAverages {
public:
    explicit BlockAverages(const AveragedSystem& system) : system_(system) {}

    /// Begins anew at `step`.
    void begin(std::int64_t step, const Look& look);
    bool has_begun() const { return has_begun_; }

    /// Whether a block ends at `step`; asked at every step that a sync has ended in or since the
    /// step before.
    bool ends_block(std::int64_t step) const;
    void end_block(std::int64_t step, const Look& look);

    /// Averages up to `step`.
    Averages averages(std::int64_t step, const Look& look) const;

private:
    static constexpr std::size_t most_blocks = 64;

    struct Block {
        double steps = 0, walls = 0, pairs = 0;
        double n_looks = 0, speed = 0, kurtosis = 0; ///< sums over looks

        Block& operator+=(const Block& other);
    };

    std::int64_t syncs_before(std::int64_t step) const {
        return step * system_.micro_steps / system_.sync_every;
    }
    double speed_of(const Look& look) const;
    static double kurtosis_of(const Look& look);
    Block block_since(std::int64_t step, const Look& before, std::int64_t now,
                      const Look& look) const;

    AveragedSystem system_;
    bool has_begun_ = false;
    std::int64_t first_step_ = 0, block_step_ = 0; ///< where it began; where the present block did
    Look first_, block_;
    std::int64_t syncs_per_block_ = 1;
    std::vector<Block> blocks_;
};

/// Gamma(n + 1/2) / Gamma(n), to a few ulp for any n >= 1.
double gamma_ratio(double n);

/// The standard error of the mean of terms that follow each other in time. Terms may hang together
/// over more than one block: the largest of the errors from single blocks and from joined ones
/// (Flyvbjerg and Petersen 1989); NaN where there are too few.
double standard_error(std::vector<double> terms);

} // namespace carrom
