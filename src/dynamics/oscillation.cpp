// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/oscillation.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/falling_frame.hpp"
#include "dynamics/never.hpp"
#include "dynamics/sine_series.hpp"

namespace carrom {

namespace {

/// A search ends after a flight has come closer to the wall's line than the amplitude this many
/// times. A parabola does so at most twice; the limit is higher because of rounding.
constexpr int most_visits = 8;
/// A search begins this fraction of a period before the disc comes within the wall's amplitude, and
/// ends one period plus this fraction after that.
constexpr double margin = 1.0 / 16;
/// A time, in periods, that is much longer than any time between syncs.
constexpr double latest = 0x1p40;

/// The angle, in turns from -1/4 to 1/4, that has this sine, by bisection.
double turns_of_sine(double sine) {
    double low = -0.25, high = 0.25;
    for (;;) {
        const double middle = low + (high - low) / 2;
        if (!(middle > low && middle < high)) return middle;
        (sine_of_turns(middle).sine < sine ? low : high) = middle;
    }
}

} // namespace

WallMotion oscillation_at(const Boundary& side, double time) {
    Oscillation oscillation(side, 1, 0, 0);
    oscillation.begin_interval(time);
    return oscillation.at(0);
}

Oscillation::Oscillation(const Boundary& side, double sign, double acceleration, double slack)
    : sign_(sign), pull_(sign * acceleration), slack_(slack) {
    if (side.kind != BoundaryKind::oscillating || !(side.amplitude > 0)) return;
    amplitude_ = side.amplitude;
    period_ = side.period;
    rate_ = two_pi / period_;
    phase_ = whole_turns_off(side.phase / two_pi);
    turns_ = phase_;
    // The wall and falling discs have the same acceleration when the sine has this value.
    const double sine = -acceleration / (amplitude_ * rate_ * rate_);
    const double bend = std::fabs(sine) < 1 ? turns_of_sine(sine) : 0.25;
    first_bend_ = whole_turns_off(bend);
    second_bend_ = whole_turns_off(std::fabs(sine) < 1 ? 0.5 - bend : 0.75);
    if (second_bend_ < first_bend_) std::swap(first_bend_, second_bend_);
}

void Oscillation::begin_interval(double time) {
    if (is_on()) turns_ = whole_turns_off(phase_ + std::fmod(time, period_) / period_);
}

WallMotion Oscillation::at(double time) const {
    const auto [sine, cosine] = sine_of_turns(turns_ + time / period_);
    const double speed = amplitude_ * rate_;
    return {amplitude_ * sine, speed * cosine, -(speed * rate_) * sine};
}

double Oscillation::pressure_at(double time, double later) const {
    return std::max(sign_ * at(time).acceleration, sign_ * at(later).acceleration) - pull_;
}

/// The flight of one disc relative to the wall's line; s is the time since `time`.
struct Oscillation::Flight {
    const Oscillation& wall;
    double distance, rate, from_wall, time;
    WallMotion now;

    ValueAndSlope distance_at(double s) const {
        const WallMotion then = wall.at(time + s);
        return {from_line_at(s) - wall.sign_ * then.place, slope_at(s, then)};
    }
    ValueAndSlope rate_at(double s) const {
        const WallMotion then = wall.at(time + s);
        return {slope_at(s, then), wall.pull_ - wall.sign_ * then.acceleration};
    }
    bool falls_at(double s) const {
        const auto [slope, bend] = rate_at(s);
        return slope < 0 || (slope == 0 && bend < 0);
    }
    /// The first time from `s` on at which the disc's distance from the wall's line is at most the
    /// amplitude minus the slack.
    double entry_after(double s) const {
        const double left = from_line_at(s) - wall.amplitude_ + wall.slack_;
        return left > 0 ? s + fall_delay(left, rate + wall.pull_ * s, wall.pull_) : s;
    }

private:
    double from_line_at(double s) const {
        return (distance + rate * s) + (0.5 * wall.pull_ * s) * s;
    }
    /// The rate at which the distance from the wall changes. At s = 0 it is exactly `from_wall`,
    /// also just after a rebound.
    double slope_at(double s, const WallMotion& then) const {
        return (from_wall + wall.pull_ * s) - wall.sign_ * (then.velocity - now.velocity);
    }
};

/// The first time after `time` at which the rate of the distance has an extremum.
double Oscillation::bend_after(double time) const {
    for (double turn = std::floor(turns_ + time / period_) - 1;; turn += 1) {
        for (const double bend : {first_bend_, second_bend_}) {
            const double then = ((turn + bend) - turns_) * period_;
            if (then > time) return then;
        }
    }
}

/// Searches at least the times from `begin` to `end`. Between two bends the rate changes its sign
/// at most once, so the distance decreases in at most one interval between them.
double Oscillation::first_contact(const Flight& flight, double begin, double end) const {
    const auto distance = [&flight](double s) { return flight.distance_at(s); };
    const auto rate = [&flight](double s) { return flight.rate_at(s); };
    double from = begin, at = flight.time + begin;
    bool falls = flight.falls_at(from);
    while (from < end) {
        at = bend_after(at);
        const double to = at - flight.time;
        const bool falls_then = flight.falls_at(to);
        if (falls || falls_then) {
            const double turn = falls == falls_then
                                    ? from
                                    : root_in_bracket(from, to, falls, flight.time, rate);
            const double top = falls ? from : turn, bottom = falls_then ? to : turn;
            if (distance(top).value <= 0) return top;
            if (distance(bottom).value < 0)
                return root_in_bracket(top, bottom, false, flight.time, distance);
        }
        from = to;
        falls = falls_then;
    }
    return never;
}

double Oscillation::contact_delay(double distance, double rate, double from_wall,
                                  double time) const {
    const Flight flight{*this, distance, rate, from_wall, time, at(time)};
    double begin = 0;
    for (int visit = 0; visit < most_visits; ++visit) {
        const double entry = flight.entry_after(begin);
        if (!(entry < latest * period_)) return never;
        const double end = entry + (1 + margin) * period_;
        const double contact = first_contact(flight, std::max(begin, entry - margin * period_),
                                             end);
        if (contact != never) return contact;
        begin = end;
    }
    return never;
}

} // namespace carrom
