// SPDX-License-Identifier: BSD-3-Clause
// Detects a jam of growing discs from numbers of collisions alone. So it is found at the same time
// for any windows, blocks and ranks, and does not depend on the speed of the machine.
//
// Near a jam the room between discs shrinks steadily until a time t_J. The pressure and the speeds
// grow as 1 / (t_J - t), because discs are compressed without loss. So the collision rate grows as
// 1 / (t_J - t)^2, and no run reaches t_J. Two consequences are used:
//   - if collisions are 4 times as frequent as some time ago, there is room for as long again;
//   - if they are more than 3 times as frequent in one of two equal bins of time as in the bin
//     before, the room does not last for another bin.
// Few collisions are no evidence and cost little, so both rules need a minimal number of collisions
// in a bin. If collisions lose energy, speeds grow less and the collision rate grows as 1 / (t_J -
// t); then the second rule ends the run.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace carrom {

/// Times are in micro-steps.
class JamWatch {
public:
    /// What the run does.
    struct Setting {
        double rate = 0;     ///< rate of radii, as a share of the initial ones per micro-step
        double interval = 1; ///< time between syncs
        double end = 0;      ///< end of the run, from its start
        double n_discs = 0;
    };
    enum class Sign { none, no_room_left, ever_more_frequent };

    /// Without a rate nothing is watched.
    explicit JamWatch(const Setting& setting);

    bool is_on() const { return setting_.rate > 0; }
    /// A run starts or continues at `time` after a sync, which is `sync` after the run's start.
    void start(double time, double sync);
    /// The end of the present bin, since the last sync. Windows must end there.
    double bin_end() const { return end_; }
    /// Adds the collisions of a window, of all ranks. Returns whether the discs jam in this bin.
    bool add(std::uint64_t n_collisions);
    /// Adds the collisions of a window, summed over all ranks. Returns whether the discs jam in
    /// this bin.
    bool finish_bin();
    /// Time up to which the discs have room, since the run's start: the beginning of the present
    /// bin, or its end after `finish_bin` has found a jam.
    double safe_until() const { return safe_until_; }

private:
    /// The collision rate in a bin that ends at `time`, since the run's start.
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
    double enough_ = 0; ///< minimal number of collisions in a bin
    /// Number of collisions in the present bin that means a jam
    double limit_ = std::numeric_limits<double>::infinity();
    double n_collisions_ = 0;
    std::vector<Past> pasts_; ///< earlier bins, in ascending order of times and rates
    Sign sign_ = Sign::none;
};

} // namespace carrom
