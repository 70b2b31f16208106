// SPDX-License-Identifier: BSD-3-Clause
// The part of a uniform acceleration that changes in time: A sin(2 pi t / P + phase) along each
// axis, with t the time since the scene's start. Both axes have the same period, so the
// acceleration may swing along a line, or rotate.
//
// All discs have the same acceleration, so it only moves the falling frame (falling_frame.hpp), and
// contacts of pairs do not depend on it. In the frame the path of a wall is a parabola plus a sine,
// and a disc meets the wall when
//
//     d + r s + g s^2 / 2 + (S (1 - cos w s) + C (w s - sin w s)) / w^2 = 0,    w = 2 pi / P,
//
// where S and C are A times the sine and the cosine of the phase at the disc's time. The third
// derivative has at most one root in an eighth of a period. So brackets find all roots of the
// second derivative, then those of the first, and no contact is missed. No nearly equal numbers are
// subtracted, however long the period is.
//
// All formulas hold up to an eighth of a period after a sync, so the reader of scenes requires at
// least one sync in each eighth of a period (scene/effects/gravity.cpp).
#pragma once

#include <array>
#include <cstddef>

namespace carrom {

struct Acceleration;

/// The motion, along one axis, of a frame that starts at rest, due to the changing acceleration.
struct Swayed {
    double way = 0, speed = 0, acceleration = 0;
};

class Sway {
public:
    Sway() = default;
    explicit Sway(const Acceleration& acceleration);

    bool is_on() const { return rate_ != 0; }
    bool acts_along(std::size_t axis) const { return amplitudes_[axis] != 0; }
    /// Starts an interval: the last sync is at `time` since the scene's start, and all other times
    /// are relative to it.
    void begin_interval(double time);
    /// The motion since the sync; `time` is at most about an eighth of a period.
    Swayed at(std::size_t axis, double time) const;
    /// Like fall_delay: the delay from `time` until a disc meets a wall; infinite if they meet
    /// later than an eighth of a period after the sync. `distance`, its `rate` at `time` and the
    /// steady `pull` are positive inwards; `sign` is 1 if inwards is towards +x or +y, else -1.
    double contact_delay(std::size_t axis, double sign, double distance, double rate, double pull,
                         double time) const;

    /// The motion up to `to` of a frame at rest at `from`; both are times since the scene's start.
    static std::array<Swayed, 2> between(const Acceleration& acceleration, double from, double to);

private:
    /// The amplitude times the sine and the cosine of the phase at a time after the sync.
    struct Phase {
        double sine = 0, cosine = 0;
    };

    Phase phase_at(std::size_t axis, double time) const;

    double rate_ = 0, period_ = 1; ///< rate: 2 pi / period
    std::array<double, 2> amplitudes_{};
    std::array<double, 2> turns_{}; ///< phases in turns at the scene's start
    std::array<Phase, 2> at_sync_{};
};

} // namespace carrom
