// SPDX-License-Identifier: BSD-3-Clause
// The event-driven method's part for growing discs (docs/understanding/effects.md, section 15).
#include <algorithm>
#include <cmath>
#include <limits>

#include "event_driven.hpp"

namespace carrom::reference {

/// The factor by which radii are larger than at first, at `time` since the last sync.
double EventDrivenReference::growth_at(double time) const {
    const auto last_sync = static_cast<double>(micro_step_ / setting_.sync_every *
                                               setting_.sync_every);
    return (1 + growth_rate() * last_sync) + growth_rate() * time;
}

double EventDrivenReference::growth_of_radius(DiscId disc) const {
    return setting_.radius_of(disc) * growth_rate();
}

/// In lengths that grow with the radii, and the clock u = t / (1 + g t), discs keep their size.
Contact EventDrivenReference::growing_contact(const DiscState& p, const DiscState& q,
                                              Copy copy) const {
    const double base = std::max(p.tau, q.tau), size = growth_at(base), g = growth_rate() / size;
    const double sigma = (setting_.radius_of(p.id) + setting_.radius_of(q.id)) * size;
    DiscState from = p, to = q;
    advance(from, base);
    advance(to, base);
    const double dx = (to.x - from.x) + copy.x * setting_.box().x,
                 dy = (to.y - from.y) + copy.y * setting_.box().y;
    const double wx = to.vx - from.vx, wy = to.vy - from.vy;
    const double vx = std::fma(-g, dx, wx), vy = std::fma(-g, dy, wy);
    const double b = dx * vx + dy * vy;
    const double p1 = dx * wy, e1 = std::fma(dx, wy, -p1);
    const double p2 = dy * wx, e2 = std::fma(dy, wx, -p2);
    const double cross = std::fabs((p1 - p2) + (e1 - e2));
    const double span = std::sqrt(vx * vx + vy * vy) * sigma;
    const double discriminant = (span - cross) * (span + cross);
    if (b >= 0 || discriminant <= 0) return {base, -1};
    const double distance = std::sqrt(dx * dx + dy * dy), gap = distance - sigma;
    if (gap <= 0) return {base, 0};
    const double u = gap * (distance + sigma) / (std::sqrt(discriminant) - b);
    const double left = std::fma(-g, u, 1.0);
    return {base, left <= 0 ? -1 : u / left};
}

EventDrivenReference::Meeting EventDrivenReference::growing_meeting(const DiscState& disc,
                                                                    DiscId axis) const {
    Meeting first{std::numeric_limits<double>::infinity(), false};
    const double radius = setting_.radius_of(disc.id) * growth_at(disc.tau);
    const double x = axis == Event::wall_x ? disc.x : disc.y,
                 v = axis == Event::wall_x ? disc.vx : disc.vy;
    for (const bool is_high : {false, true}) {
        const double gap = is_high ? (setting_.edge(2 * axis) - radius) - x : x - radius;
        const double approach = growth_of_radius(disc.id) - (is_high ? -v : v);
        if (approach <= 0) continue;
        const double time = disc.tau + (gap <= 0 ? 0 : gap / approach);
        if (time < first.time) first = {time, is_high};
    }
    return first;
}

/// For touching discs: their surfaces separate along the line of centres with `restitution` times
/// the speed at which they met.
void EventDrivenReference::push_growing(DiscState& p, DiscState& q, double restitution,
                                        Copy copy) const {
    const double ex = (q.x - p.x) + copy.x * setting_.box().x,
                 ey = (q.y - p.y) + copy.y * setting_.box().y;
    const double g = growth_rate() / growth_at(p.tau);
    const double wx = std::fma(-g, ex, q.vx - p.vx), wy = std::fma(-g, ey, q.vy - p.vy);
    const double k = (1 + restitution) / 2 * ((wx * ex + wy * ey) / (ex * ex + ey * ey));
    const double mp = setting_.mass_of(p.id), mq = setting_.mass_of(q.id), mean = (mp + mq) / 2;
    p.vx += k * (mq / mean) * ex;
    p.vy += k * (mq / mean) * ey;
    q.vx -= k * (mp / mean) * ex;
    q.vy -= k * (mp / mean) * ey;
}

} // namespace carrom::reference
