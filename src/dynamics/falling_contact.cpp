// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/falling_contact.hpp"
#include "dynamics/never.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace carrom {

namespace {

/// Newton's rule takes some ten steps. Halving alone takes few more to bring a bracket
/// to its last bit.
constexpr int most_newton_steps = 100;

struct Value {
    double value, slope;
};

/// The root of a function with different signs at the ends, given its value and slope at a time.
template <class Function>
double root_between(double low, double high, bool rises, const Function& function) {
    double s = low + (high - low) / 2;
    for (int k = 0; k < most_newton_steps; ++k) {
        const auto [value, slope] = function(s);
        ((value < 0) == rises ? low : high) = s;
        double next = s - value / slope;
        if (!(next > low && next < high)) next = low + (high - low) / 2;
        if (next == s || !(next > low && next < high)) break;
        s = next;
    }
    return s;
}

struct Parabola {
    double dx, dy, wx, wy, gx, gy, reach;

    Value gap(double s) const {
        const auto [x, y, vx, vy] = at(s);
        const double distance = std::sqrt(x * x + y * y);
        return {distance - reach, (x * vx + y * vy) / distance};
    }
    /// Half the rate of the squared distance.
    Value rate(double s) const {
        const auto [x, y, vx, vy] = at(s);
        return {x * vx + y * vy, (vx * vx + vy * vy) + (x * gx + y * gy)};
    }
    /// The times at which the rate turns round, ascending; both infinite if it never does.
    std::array<double, 2> bends() const {
        const double a = 1.5 * (gx * gx + gy * gy), b = 3 * (wx * gx + wy * gy),
                     c = (wx * wx + wy * wy) + (dx * gx + dy * gy);
        const double square = b * b - 4 * a * c;
        if (!(square > 0)) return {never, never};
        const double sum = -(b + std::copysign(std::sqrt(square), b)) / 2;
        std::array<double, 2> found{sum / a, c / sum};
        if (found[1] < found[0]) std::swap(found[0], found[1]);
        return found;
    }
    /// A time after `s` from which the distance grows for good.
    double late(double s) const {
        const double g = std::sqrt(gx * gx + gy * gy);
        double step = std::sqrt(wx * wx + wy * wy) / g +
                      std::sqrt(std::sqrt(dx * dx + dy * dy) / g);
        while (rate(s + step).value < 0) step *= 2;
        return s + step;
    }

private:
    std::array<double, 4> at(double s) const {
        return {(dx + wx * s) + (0.5 * gx * s) * s, (dy + wy * s) + (0.5 * gy * s) * s, wx + gx * s,
                wy + gy * s};
    }
};

} // namespace

double falling_contact(double dx, double dy, double wx, double wy, double gx, double gy,
                       double reach) {
    const Parabola flight{dx, dy, wx, wy, gx, gy, reach};
    const auto rate = [&flight](double s) { return flight.rate(s); };
    double start = 0; // the begin of the present piece
    double fall = 0;  // the time since which the distance falls, if it does
    bool falls = flight.rate(0).value < 0;
    const auto [first, second] = flight.bends();
    for (const double bend : {first, second, never}) {
        if (!(bend > start)) continue;
        if (bend == never && !falls) return never; // it grows ever faster
        const double end = bend == never ? flight.late(start) : bend;
        const bool falls_at_end = bend != never && flight.rate(end).value < 0;
        if (falls != falls_at_end) {
            const double turn = root_between(start, end, falls, rate);
            if (falls) {
                if (flight.gap(fall).value <= 0) return fall;
                if (flight.gap(turn).value < 0)
                    return root_between(fall, turn, false,
                                        [&flight](double s) { return flight.gap(s); });
            }
            fall = turn;
            falls = falls_at_end;
        }
        if (bend == never) return never;
        start = end;
    }
    return never;
}

} // namespace carrom
