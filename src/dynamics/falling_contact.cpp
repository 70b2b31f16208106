// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/falling_contact.hpp"

#include "dynamics/never.hpp"
#include "dynamics/parabola.hpp"

namespace carrom {

double falling_contact(double dx, double dy, double wx, double wy, double gx, double gy,
                       double reach) {
    const Parabola flight{dx, dy, wx, wy, gx, gy, reach};
    const auto rate = [&flight](double s) { return flight.rate(s); };
    double start = 0; // start of the current piece of time
    double fall = 0;  // if the distance decreases: the time when it began to
    bool falls = flight.rate(0).value < 0;
    const auto [first, second] = flight.bends();
    for (const double bend : {first, second, never}) {
        if (!(bend > start)) continue;
        if (bend == never && !falls) return never; // from here on the distance only increases
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
