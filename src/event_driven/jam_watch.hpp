// SPDX-License-Identifier: BSD-3-Clause
// Finds that growing discs jam, from numbers of collisions alone. So every cut into windows, blocks
// and ranks finds it at the same time, and a slow machine jams no earlier than a fast one.
//
// Near a jam the room between discs shrinks steadily until a time t_J. The pressure goes as
// 1 / (t_J - t) and speeds do as well, because discs are compressed without loss. So collisions
// become frequent as 1 / (t_J - t)^2, and no run comes to t_J. Two consequences are used:
//   - if collisions are 4 times as frequent as some time ago, the room lasts for as long again;
//   - if they are more than 3 times as frequent in one of two equal bins of time as in the bin
//     before, the room does not last for another bin.
// Few collisions show nothing and cost little, so both count only beyond a number of collisions in
// a bin. With losses speeds grow less, and collisions as 1 / (t_J - t): then the second rule ends
// the run.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace carrom {

/// Times are in micro-steps.
class JamWatch {
public:
    /// What growing discs are like.
    struct Growth {
        double rate = 0;     ///< of radii, as a share of the first ones per micro-step
        double interval = 1; ///< from one sync to the next
        double end = 0;      ///< of the run, since its start
        double n_discs = 0;
    };
    enum class Sign { none, no_room_left, ever_more_frequent };

    /// Watches nothing if discs do not grow.
    explicit JamWatch(const Growth& growth);

    bool is_on() const { return growth_.rate > 0; }
    /// A run begins or goes on at `time` after a sync, `sync` after its start.
    void start(double time, double sync);
    /// Where windows end, since the last sync.
    double bin_end() const { return end_; }
    /// Adds the collisions of a window, of all ranks. Returns whether the discs jam in this bin.
    bool add(std::uint64_t n_collisions);
    /// The time has come to `bin_end()`. Returns whether there is no room until the run's end.
    bool finish_bin();
    /// The begin of the present bin, since the run's start, or its end after `finish_bin` has
    /// found a jam: the discs had room until then.
    double safe_until() const { return safe_until_; }

private:
    /// The frequency of collisions in a bin that ends at `time`, since the run's start.
    struct Past {
        double time = 0, rate = 0;
    };
    void begin_bin(double begin, double width);
    void remember(const Past& bin);
    const Past* when_rarer(double rate) const;

    Growth growth_;
    double width_ = 1; ///< of bins, except the first ones after a start
    double sync_ = 0;  ///< the last sync, since the run's start
    double begin_ = 0, end_ = std::numeric_limits<double>::infinity();
    double safe_until_ = 0;
    double enough_ = 0;                                      ///< collisions in a bin that count
    double limit_ = std::numeric_limits<double>::infinity(); ///< for those of the present bin
    double n_collisions_ = 0;
    std::vector<Past> pasts_; ///< times and rates rise
    Sign sign_ = Sign::none;
};

} // namespace carrom
