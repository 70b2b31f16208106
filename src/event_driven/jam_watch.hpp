// SPDX-License-Identifier: BSD-3-Clause
// Detects a jam of growing discs from numbers of collisions alone. So the simulated time at which a
// jam is found does not depend on windows, blocks and ranks, nor on the speed of the machine.
//
// Near a jam the room between discs shrinks steadily until a time t_J. The pressure and the speeds
// grow as 1 / (t_J - t), because discs are compressed without loss. So the collision rate grows as
// 1 / (t_J - t)^2, and no run reaches t_J. Two consequences are used:
//   - if collisions are 4 times as frequent as a time dt ago, discs have room only for another dt;
//   - if they are more than 3 times as frequent in a bin of time as in the bin of the same length
//     before it, discs have no room for another bin.
// Few collisions are no evidence and cost little, so both rules need a minimal number of collisions
// in a bin. If collisions lose energy, speeds grow less and the collision rate grows as 1 / (t_J -
// t); then the second rule ends the run.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace carrom {

/// Watches a run for a jam. Times are in micro-steps.
class JamWatch {
public:
    /// The facts about the run that the watch needs.
    struct Setting {
        double rate = 0;     ///< growth of radii per micro-step, relative to the initial radii
        double interval = 1; ///< time between syncs
        double end = 0;      ///< end of the run, from its start
        double n_discs = 0;
    };
    enum class Sign { none, no_room_left, ever_more_frequent };

    /// If the rate is 0, nothing is watched.
    explicit JamWatch(const Setting& setting);

    bool is_on() const { return setting_.rate > 0; }
    /// Begins to watch. `time` is the time since the last sync, and `sync` is the time of that sync
    /// since the run's start.
    void start(double time, double sync);
    /// The end of the present bin, as a time since the last sync. Windows must end there.
    double bin_end() const { return end_; }
    /// Adds a window's collisions, summed over all ranks. Returns whether a jam has been found.
    bool add(std::uint64_t n_collisions);
    /// Ends the present bin, compares its collision rate with earlier bins, and starts the next
    /// one. Returns whether a jam has been found.
    bool finish_bin();
    /// The time, from the run's start, until which the discs have room: the beginning of the
    /// present bin, or its end after `finish_bin` has found a jam.
    double safe_until() const { return safe_until_; }

private:
    /// A finished bin: its end as a time since the run's start, and its collision rate.
    struct Past {
        double time = 0, rate = 0;
    };
    void begin_bin(double begin, double width);
    void remember(const Past& bin);
    const Past* when_rarer(double rate) const;

    Setting setting_;
    double width_ = 1; ///< width of the bins, except the first ones after a start
    double sync_ = 0;  ///< time of the last sync, since the run's start
    double begin_ = 0, end_ = std::numeric_limits<double>::infinity();
    double safe_until_ = 0;
    double enough_ = 0; ///< a bin with fewer collisions never shows a jam
    /// More collisions than this in the present bin mean a jam
    double limit_ = std::numeric_limits<double>::infinity();
    double n_collisions_ = 0;
    std::vector<Past> pasts_; ///< earlier bins, in ascending order of times and rates
    Sign sign_ = Sign::none;
};

} // namespace carrom
