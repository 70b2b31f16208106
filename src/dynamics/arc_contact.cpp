// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/arc_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "dynamics/growing_contact.hpp"
#include "dynamics/never.hpp"
#include "dynamics/parabola.hpp"

namespace carrom {

namespace {

/// Because of rounding, a disc that slides from a tangent line onto an arc may reach the arc's
/// circle just before the arc begins. So the inner face is extended along its tangent by this
/// fraction of the radius. There the tangent is within 5e-15 of the radius from the circle.
constexpr double slip = 1e-7;

/// The time at which a flight leaves the circle of radius `reach`; `never` if the flight misses
/// this circle, or if the disc's centre is beyond the radius `wall` and moves away.
double way_out(const ArcFlight& f, double reach, double wall) {
    const double b = f.dx * f.wx + f.dy * f.wy, a = f.wx * f.wx + f.wy * f.wy;
    if (!(reach > 0) || !(a > 0)) return never;
    const double distance = std::sqrt(f.dx * f.dx + f.dy * f.dy);
    if (b >= 0 && distance >= reach) return distance < wall ? 0 : never;
    const double speed = std::sqrt(a), most = speed * reach,
                 x = std::fabs(cross(f.dx, f.dy, f.wx, f.wy));
    const double square = (most - x) * (most + x);
    // The flight misses the circle. If it comes within the radius `wall`, rounding is the cause.
    if (!(square > 0)) return b < 0 && x < speed * wall ? -b / a : never;
    const double root = std::sqrt(square);
    return b < 0 ? (root - b) / a : (reach - distance) * (reach + distance) / (b + root);
}

/// The time at which a disc that grows inside the circle of radius `wall` touches it, or `never`.
/// In lengths divided by 1 - g t, with g = rate / (wall - radius), and with the clock u = t / (1 -
/// g t), the disc's centre flies straight inside a circle of constant radius
/// (growing_contact.hpp).
double growing_way_out(const ArcFlight& f, const DiscSize& size, double wall) {
    const double room = wall - size.radius;
    if (!(room > 0)) return never;
    const double shrinks = size.rate_of(room);
    const double clock = way_out(
        {f.dx, f.dy, std::fma(shrinks, f.dx, f.wx), std::fma(shrinks, f.dy, f.wy)}, room, wall);
    return clock < never ? clock / std::fma(shrinks, clock, 1.0) : never;
}

/// The times, ascending, at which the distance from the arc's centre has a minimum or maximum.
struct Turns {
    std::array<double, 3> times{};
    std::size_t n = 0;
};

Turns turns_of(const Parabola& flight) {
    Turns turns;
    const auto rate = [&flight](double s) { return flight.rate(s); };
    double start = 0;
    bool falls = flight.rate(0).value < 0;
    const auto [first, second] = flight.bends();
    for (const double bend : {first, second, never}) {
        if (!(bend > start)) continue;
        if (bend == never && !falls) break; // the distance then grows for ever
        const double end = bend == never ? flight.late(start) : bend;
        const bool falls_at_end = bend != never && flight.rate(end).value < 0;
        if (falls != falls_at_end) {
            turns.times[turns.n++] = root_between(start, end, falls, rate);
            falls = falls_at_end;
        }
        if (bend == never) break;
        start = end;
    }
    return turns;
}

/// The time of contact with the outer face in [begin, end], while the distance falls; or `never`.
double contact_while_falling(Parabola flight, double outer, double wall, double begin, double end) {
    flight.reach = outer;
    if (flight.gap(begin).value <= 0) return flight.gap(begin).value + outer < wall ? never : begin;
    if (!(flight.gap(end).value < 0)) return never;
    return root_between(begin, end, false, [&flight](double s) { return flight.gap(s); });
}

/// Like contact_while_falling, for the inner face and a rising distance; `end` may be `never`.
double contact_while_rising(Parabola flight, double inner, double wall, double begin, double end) {
    flight.reach = inner;
    if (!(inner > 0)) return never;
    if (flight.gap(begin).value >= 0) return flight.gap(begin).value + inner < wall ? begin : never;
    if (end == never)
        for (end = flight.late(begin); !(flight.gap(end).value > 0);) end += end - begin;
    if (!(flight.gap(end).value > 0)) return never;
    return root_between(begin, end, true, [&flight](double s) { return flight.gap(s); });
}

} // namespace

double arc_contact(const ArcFlight& flight, const DiscSize& size, double arc_radius,
                   const ArcSpan& span) {
    const auto is_there = [&](double s) {
        const double x = flight.dx + flight.wx * s, y = flight.dy + flight.wy * s;
        return span.holds(x, y, std::sqrt(x * x + y * y));
    };
    const auto [dx, dy, wx, wy] = flight;
    // If the disc's centre is inside the arc, an overlap with the outer face is not a contact.
    const double reach = arc_radius + size.radius;
    const double in = growing_contact_delay(-dx, -dy, -wx, -wy, reach, size.rate_of(reach),
                                            size.radius);
    if (in >= 0 && is_there(in)) return in;
    const double out = growing_way_out(flight, size, arc_radius);
    if (!(out < never)) return never;
    return is_there(out) || is_there(out + slip * arc_radius / std::hypot(wx, wy)) ? out : never;
}

double falling_arc_contact(const ArcFlight& flight, double gx, double gy, double radius,
                           double arc_radius, const ArcSpan& span) {
    const double dx = flight.dx, dy = flight.dy, wx = flight.wx, wy = flight.wy;
    const Parabola path{dx, dy, wx, wy, gx, gy, 0};
    const auto is_there = [&](double s) {
        const double x = (dx + wx * s) + (0.5 * gx * s) * s, y = (dy + wy * s) + (0.5 * gy * s) * s;
        return span.holds(x, y, std::sqrt(x * x + y * y));
    };
    const Turns turns = turns_of(path);
    bool falls = path.rate(0).value < 0;
    double begin = 0;
    for (std::size_t k = 0; k <= turns.n; ++k, falls = !falls) {
        const double end = k < turns.n ? turns.times[k] : never;
        const double time = falls ? contact_while_falling(path, arc_radius + radius, arc_radius,
                                                          begin, end)
                                  : contact_while_rising(path, arc_radius - radius, arc_radius,
                                                         begin, end);
        const auto comes_soon = [&] {
            const double speed = std::hypot(wx + gx * time, wy + gy * time);
            return !falls && speed > 0 && is_there(time + slip * arc_radius / speed);
        };
        if (time < never && (is_there(time) || comes_soon())) return time;
        begin = end;
    }
    return never;
}

} // namespace carrom
