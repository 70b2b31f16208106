// SPDX-License-Identifier: BSD-3-Clause
// The time-stepped method with the formulas of the course program: a check of time_stepped.hpp by
// other arithmetic.
//
// Every position is advanced to the end of every micro-step, contact times are (-B - sqrt(B^2 -
// 4AC)) / 2A from the positions at its start, and velocities are split into normal and tangential
// parts. Order, corners, band and stops are the same. It agrees with time_stepped.hpp to rounding
// until trajectories diverge, and exactly if every number is exact in binary. It has no tolerance:
// touching pairs that overlap by rounding pass through each other here.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "time_stepped.hpp"

namespace carrom::reference {

class LegacyReference {
public:
    LegacyReference(const Setting& setting, std::span<const InputDisc> discs);

    void run_micro_steps(std::int64_t count);
    void run_steps(std::int64_t count) { run_micro_steps(count * setting_.micro_steps); }

    /// Discs in the order of ids at the present time; tau stays 0, velocities are per micro-step.
    std::span<const DiscState> discs() const { return discs_; }
    const Counters& counters() const { return counters_; }
    const std::vector<Collision>& log() const { return log_; }

private:
    struct Walls {
        bool x = false, y = false;
        double t = 2; ///< a value above 1 means no wall in this micro-step
    };

    void run_micro_step();
    std::vector<Collision> candidates() const;
    Walls walls_of(const DiscState& disc) const;
    void bounce(DiscState& disc, const Walls& walls) const;
    void finish(DiscState& disc, double t) const;

    Setting setting_;
    double low_, high_, band_;
    std::vector<DiscState> discs_;
    std::int64_t micro_step_ = 0;
    Counters counters_;
    std::vector<Collision> log_;
};

} // namespace carrom::reference
