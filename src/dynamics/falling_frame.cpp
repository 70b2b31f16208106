// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/falling_frame.hpp"

#include <array>
#include <cstddef>

#include "dynamics/drag.hpp"

namespace carrom {

namespace {

/// Contacts count only while 1 - c s, by which drag multiplies velocities, is at least this.
constexpr double least_slowing = 0.01;
/// Maximum number of steps of Newton's method; four to twelve are needed.
constexpr int most_steps = 100;

/// (-log(1 - q) - q) / q^2 for q up to 1/4: with z = q / (2 - q) it is (1 + 2 z (1/3 + z^2/5 +
/// z^4/7 + ...) / (2 - q)) / (2 - q).
double short_fall(double q) {
    const double part = 1 / (2 - q), z = q * part, square = z * z;
    double sum = 0;
    for (int k = 21; k >= 3; k -= 2) sum = 1.0 / k + square * sum; // the next term is below 2^-60
    return part * (1 + 2 * z * part * sum);
}

} // namespace

double dragged_fall(double rate, double clock) {
    const double q = rate * clock;
    if (!(q > 0.25)) return clock * clock * short_fall(q);
    // After half the time the clock shows s' with 1 - c s' = sqrt(1 - c s), so F(s) = 2 F(s') +
    // s'^2, which is a sum of positive terms.
    const double half = clock / (1 + std::sqrt(1 - q));
    return 2 * dragged_fall(rate, half) + half * half;
}

double dragged_fall_delay(double distance, double velocity, double pull, double rate) {
    // Because F(s) >= s^2 / 2, the contact time for F = s^2 / 2 is too late if the disc is pulled
    // to the wall, and too early if it is pulled away.
    double s = fall_delay(distance, velocity, pull);
    if (pull == 0 || s == 0) return s;
    const double latest = (1 - least_slowing) / rate;
    const auto height = [=](double at) {
        return (distance + velocity * at) + pull * dragged_fall(rate, at);
    };
    // The distance has its extremum where velocity + pull F'(s) = 0.
    const double turn = std::min(
        std::fabs(velocity) / (std::fabs(pull) + rate * std::fabs(velocity)), latest);
    const bool is_pulled_on = pull < 0;
    if (is_pulled_on) {
        if (velocity >= 0 && !(height(turn) > 0)) return turn;
        s = std::min(s, latest);
        if (height(s) > 0) return s == latest ? never : s; // the height is only a rounding error
    } else if (!(s < turn) || !(height(turn) < 0)) {
        return never;
    }
    for (int k = 0; k < most_steps; ++k) {
        const double next = s - height(s) / (velocity + pull * dragged_fall_speed(rate, s));
        const bool is_step = is_pulled_on ? next < s && next > (velocity < 0 ? 0 : turn)
                                          : next > s && next < turn;
        if (!is_step) break;
        s = next;
    }
    return s;
}

double FallingFrame::clock_at(double micro_steps) const {
    return drag_ == 0 ? micro_steps : drag_clock(drag_, micro_steps);
}

double FallingFrame::micro_steps_at(double clock) const { return time_of_drag_clock(drag_, clock); }

/// The velocity in the box is (1 - c s) v + g s, and the time of a step ds of the clock is ds / (1
/// - c s). With q = c s the integrands are 1 - q for v v, s for v g, and s^2 / (1 - q) for g g.
/// Completing the square in v gives the form of FlightIntegral.
FlightIntegral FallingFrame::flight_integral_at(double time) const {
    if (!(time > 0)) return {};
    const double q = drag_ * time, weight = time * (1 - 0.5 * q);
    if (!acceleration_.is_on()) return {weight, 0, 0, 0, 0};
    if (sway_.is_on()) return swaying_flight_integral_at(time);
    double of_squares = 0; // the integral of s^2 / (1 - q), divided by s^3
    if (q < 0x1p-6) {
        for (int k = 10; k >= 3; --k) of_squares = 1.0 / k + q * of_squares;
    } else {
        of_squares = (dragged_fall(drag_, time) / (time * time) - 0.5) / q;
    }
    const double shift = 0.5 * time / (1 - 0.5 * q);
    const double rest = time * std::sqrt(time * (of_squares - 0.25 / (1 - 0.5 * q)));
    return {weight, shift * acceleration_.x, shift * acceleration_.y, rest * acceleration_.x,
            rest * acceleration_.y};
}

namespace {

/// The positive nodes of Gauss's rule with eight points from -1 to 1, and their weights. A flight
/// lasts at most an eighth of a period, for which the rule's error is below the rounding error.
constexpr std::array<double, 4> gauss_nodes = {0.1834346424956498, 0.5255324099163290,
                                               0.7966664774136267, 0.9602898564975363},
                                gauss_weights = {0.3626837833783620, 0.3137066458778873,
                                                 0.2223810344533745, 0.1012285362903763};

} // namespace

/// `rest_x`, `rest_y` and `more_y` are the elements of the triangular Cholesky factor of the
/// integral of (u - mean)(u - mean)^T, where u is the frame's velocity.
FlightIntegral FallingFrame::swaying_flight_integral_at(double time) const {
    const Frame end = moving_at(time);
    const double mean_x = end.x / time, mean_y = end.y / time;
    double xx = 0, xy = 0, yy = 0;
    for (std::size_t k = 0; k < gauss_nodes.size(); ++k)
        for (const double sign : {-1.0, 1.0}) {
            const Frame then = moving_at(time * (0.5 + sign * 0.5 * gauss_nodes[k]));
            const double ux = then.vx - mean_x, uy = then.vy - mean_y,
                         weight = 0.5 * time * gauss_weights[k];
            xx += weight * (ux * ux), xy += weight * (ux * uy), yy += weight * (uy * uy);
        }
    FlightIntegral integral{time, mean_x, mean_y, std::sqrt(xx), 0};
    if (integral.rest_x > 0) integral.rest_y = xy / integral.rest_x;
    integral.more_y = std::sqrt(std::max(yy - integral.rest_y * integral.rest_y, 0.0));
    return integral;
}

Frame FallingFrame::moving_at(double time) const {
    Frame frame{true,
                fallen(acceleration_.x, time),
                fallen(acceleration_.y, time),
                acceleration_.x * time,
                acceleration_.y * time,
                slowing_at(time),
                time};
    if (!sway_.is_on()) return frame;
    const Swayed x = sway_.at(0, time), y = sway_.at(1, time);
    frame.x += x.way, frame.y += y.way;
    frame.vx += x.speed, frame.vy += y.speed;
    return frame;
}

} // namespace carrom
