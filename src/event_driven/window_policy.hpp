// SPDX-License-Identifier: BSD-3-Clause
// Chooses each window of a run by what happened in earlier windows: how often discs collided, how
// many block runs had to be repeated, and how fast discs have become. The choice uses only numbers
// that are equal on all ranks. It affects the run's time, not its bits.
#pragma once

#include <optional>

#include "event_driven/block_run.hpp"
#include "event_driven/block_window.hpp"

namespace carrom {

/// Settings that do not change during a run; equal on all ranks.
struct WindowSetting {
    std::optional<double> duration; ///< duration of a window in micro-steps; chosen if unset
    std::optional<int> halo;        ///< halo of a block's first run, in reaches; chosen if unset
    /// Bound of speeds, relative to the largest speed at a window's start
    double speed_allowance = 1.08;
    double n_threads = 0; ///< threads of all ranks together; 0 if each rank has one thread
};

/// The choice of a window, and the window's end in micro-steps since the last sync.
struct PlannedWindow {
    BlockChoice choice;
    double end = 0;
};

/// A round of repeated block runs; the numbers are equal on all ranks.
struct Rollback {
    double repeated = 0;         ///< number of repeated block runs, divided by the number of blocks
    double waited = 0;           ///< extra time of the slowest rank, relative to its first runs
    double price_of_reach = 0.1; ///< extra time with halos one reach deeper, relative to first runs
};

class WindowPolicy {
public:
    explicit WindowPolicy(const WindowSetting& setting) : setting_(setting) {}

    /// An estimate, at most `target`, of the end of a window that begins at `time`.
    double soon(double time, double target) const;
    /// The speed bound of the next window. `largest` is the largest speed at its start,
    /// `last_bound` the last window's bound, and `gained` the speed that discs may gain in a frame
    /// that falls. The bound falls only slowly, because the largest speed fluctuates.
    double speed_bound(double largest, double last_bound, double gained) const;

    /// Plans the next window, from `needs.time` to `target` or earlier. `collision_rate` is the
    /// rate in the previous window, or a guess for the first window. `longest` is the longest
    /// window that the box permits. `needs` must have all numbers that are not learned from past
    /// windows.
    PlannedWindow plan(BlockNeeds needs, double collision_rate, double longest, double target);

    /// Call it for each round of repeated runs in the planned window.
    void note(const Rollback& rollback);
    /// Call it at the end of the window.
    void record_end(double duration) { last_duration_ = duration; }

    double last_duration() const { return last_duration_; }
    /// Collisions per disc and micro-step in the last window.
    double collision_rate() const { return collision_rate_; }
    double speed_allowance() const { return setting_.speed_allowance; }

private:
    void learn(double collision_rate, BlockNeeds& needs);

    WindowSetting setting_;
    double collision_rate_ = 0;
    double rate_to_expect_ = 0;   ///< collision rate used for the choice; it falls only slowly
    double last_duration_ = 1;    ///< duration of the last window
    double rounds_lately_ = 0.05; ///< running mean of `n_rounds_` over windows
    double n_rounds_ = 0;         ///< number of rounds of repeated runs in the last window
    Rollback last_;               ///< sums over these rounds; `price_of_reach` of the last round
    Caution caution_;
};

/// The window for a higher speed bound. It is shorter, so that its reach stays the same. If the old
/// bound was 0, because all discs were at rest until a wall reached them, the new window lasts at
/// most as long as a disc needs to fly one diameter at the new bound.
BlockWindow shortened(BlockWindow window, double speed_bound, double diameter);

} // namespace carrom
