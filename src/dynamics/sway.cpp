// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/sway.hpp"

#include <cmath>

#include "dynamics/effects.hpp"
#include "dynamics/never.hpp"
#include "dynamics/sine_series.hpp"

namespace carrom {

namespace {

/// The longest time after a sync, in periods, in which contacts are searched for.
constexpr double longest_arc = 0.125 * (1 + 0x1p-10);

/// For a small angle x: its sine, 1 - cos x and x - sin x, each accurate to a few roundings.
struct Turn {
    explicit Turn(double x) {
        const double square = x * x;
        lag = -x * (square * series(sine_terms, square));
        sine = x - lag;
        versine = square / 2 - square * (square * series(cosine_terms, square));
    }

    double sine, versine, lag;
};

/// A disc's flight relative to a wall; s is the time since the time of the disc's state.
struct SwayingFlight {
    double distance, speed, pull;
    double sine, cosine; ///< amplitude times sine and cosine of the phase at s = 0
    double rate;         ///< angular frequency, 2 pi / period

    ValueAndSlope distance_at(double s) const {
        const Turn arc(rate * s);
        const double way = (sine * arc.versine + cosine * arc.lag) / (rate * rate);
        return {(distance + speed * s) + ((0.5 * pull * s) * s + way), speed_of(arc, s)};
    }
    ValueAndSlope speed_at(double s) const {
        const Turn arc(rate * s);
        return {speed_of(arc, s), pull_of(arc)};
    }
    ValueAndSlope pull_at(double s) const {
        const Turn arc(rate * s);
        return {pull_of(arc), rate * bend_of(arc)};
    }
    /// The derivative of the acceleration, divided by the angular frequency.
    ValueAndSlope bend_at(double s) const {
        const Turn arc(rate * s);
        return {bend_of(arc), rate * (pull - pull_of(arc))};
    }
    bool falls_at(double s) const {
        const auto [slope, bend] = speed_at(s);
        return slope < 0 || (slope == 0 && bend < 0);
    }

private:
    double speed_of(const Turn& arc, double s) const {
        return (speed + pull * s) + (sine * arc.sine + cosine * arc.versine) / rate;
    }
    double pull_of(const Turn& arc) const {
        return pull + (sine * (1 - arc.versine) + cosine * arc.sine);
    }
    double bend_of(const Turn& arc) const { return cosine * (1 - arc.versine) - sine * arc.sine; }
};

/// Times that cut an interval into pieces: its beginning, at most three roots, and its end.
class Cuts {
public:
    Cuts(double begin, double end) : end_(end) { add(begin); }

    void add(double time) { times_[n_++] = time; }
    std::size_t n_pieces() const { return n_; }
    double begin(std::size_t k) const { return times_[k]; }
    double end(std::size_t k) const { return k + 1 < n_ ? times_[k + 1] : end_; }

private:
    std::array<double, 4> times_{};
    std::size_t n_ = 0;
    double end_;
};

/// The pieces in which a function is monotone. In each of `pieces` its derivative `slope` is
/// monotone, so it has at most one root there.
template <class Function>
Cuts cut_at_roots(const Cuts& pieces, double end, double origin, const Function& slope) {
    Cuts cuts(pieces.begin(0), end);
    for (std::size_t k = 0; k < pieces.n_pieces(); ++k) {
        const double from = pieces.begin(k), to = pieces.end(k);
        const bool is_up = slope(from).value > 0, is_up_then = slope(to).value > 0;
        if (is_up != is_up_then) cuts.add(root_in_bracket(from, to, is_up_then, origin, slope));
    }
    return cuts;
}

/// The first time in [0, end] at which the distance is not positive and falls.
double first_contact(const SwayingFlight& flight, double end, double origin) {
    const auto distance = [&flight](double s) { return flight.distance_at(s); };
    const auto speed = [&flight](double s) { return flight.speed_at(s); };
    Cuts pieces(0, end);
    const bool may_turn = std::fabs(flight.pull) <=
                          std::fabs(flight.sine) + std::fabs(flight.cosine);
    if (may_turn) {
        pieces = cut_at_roots(pieces, end, origin, [&](double s) { return flight.bend_at(s); });
        pieces = cut_at_roots(pieces, end, origin, [&](double s) { return flight.pull_at(s); });
    }
    bool falls = flight.falls_at(0);
    for (std::size_t k = 0; k < pieces.n_pieces(); ++k) {
        const double from = pieces.begin(k), to = pieces.end(k);
        const bool falls_then = flight.falls_at(to);
        if (falls || falls_then) {
            const double turn = falls == falls_then
                                    ? from
                                    : root_in_bracket(from, to, falls, origin, speed);
            const double top = falls ? from : turn, bottom = falls_then ? to : turn;
            if (distance(top).value <= 0) return top;
            if (distance(bottom).value < 0)
                return root_in_bracket(top, bottom, false, origin, distance);
        }
        falls = falls_then;
    }
    return never;
}

} // namespace

Sway::Sway(const Acceleration& acceleration) {
    if (!acceleration.sways()) return;
    period_ = acceleration.period;
    rate_ = two_pi / period_;
    amplitudes_ = {acceleration.amplitude_x, acceleration.amplitude_y};
    turns_ = {whole_turns_off(acceleration.phase_x / two_pi),
              whole_turns_off(acceleration.phase_y / two_pi)};
    begin_interval(0);
}

void Sway::begin_interval(double time) {
    if (!is_on()) return;
    const double turned = std::fmod(time, period_) / period_;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const auto [sine, cosine] = sine_of_turns(whole_turns_off(turns_[axis] + turned));
        at_sync_[axis] = {amplitudes_[axis] * sine, amplitudes_[axis] * cosine};
    }
}

Sway::Phase Sway::phase_at(std::size_t axis, double time) const {
    const auto& [sine, cosine] = at_sync_[axis];
    const Turn arc(rate_ * time);
    return {sine * (1 - arc.versine) + cosine * arc.sine,
            cosine * (1 - arc.versine) - sine * arc.sine};
}

Swayed Sway::at(std::size_t axis, double time) const {
    const auto& [sine, cosine] = at_sync_[axis];
    const Turn arc(rate_ * time);
    return {(sine * arc.versine + cosine * arc.lag) / (rate_ * rate_),
            (sine * arc.sine + cosine * arc.versine) / rate_,
            sine * (1 - arc.versine) + cosine * arc.sine};
}

double Sway::contact_delay(std::size_t axis, double sign, double distance, double rate, double pull,
                           double time) const {
    const double end = longest_arc * period_ - time;
    if (!(end > 0)) return never;
    const Phase phase = phase_at(axis, time);
    return first_contact({distance, rate, pull, sign * phase.sine, sign * phase.cosine, rate_}, end,
                         time);
}

std::array<Swayed, 2> Sway::between(const Acceleration& acceleration, double from, double to) {
    if (!acceleration.sways()) return {};
    Sway sway(acceleration);
    sway.begin_interval(from);
    const double time = to - from;
    if (time <= longest_arc * acceleration.period) return {sway.at(0, time), sway.at(1, time)};
    Sway then(acceleration);
    then.begin_interval(to);
    std::array<Swayed, 2> all;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const Phase &first = sway.at_sync_[axis], &last = then.at_sync_[axis];
        all[axis] = {(first.cosine * time - (last.sine - first.sine) / sway.rate_) / sway.rate_,
                     (first.cosine - last.cosine) / sway.rate_, last.sine};
    }
    return all;
}

} // namespace carrom
