// SPDX-License-Identifier: BSD-3-Clause
// The laws of a scene that names no effect: free flight, elastic pairs, four elastic walls (docs/method.md, section 3).
//
// Kernels take the law as a template argument and ask it what a disc does; another set of effects is another law with
// the same members, chosen once at start. Under the rule "one" times t are in-step times of the micro-step [m, m+1];
// m is exact in a double.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "carrom/core/disc.hpp"
#include "carrom/geometry/pair_contact.hpp"

namespace carrom {

class PlainLaw {
public:
    static constexpr double never = std::numeric_limits<double>::infinity();

    PlainLaw(double box_size, double radius)
        : box_size_(box_size), radius_(radius), diameter_(2 * radius), band_(1e-8 * radius),
          tolerance_(std::max(1e-12 * diameter_, 32 * 0x1p-53 * box_size)) {}

    double box_size() const { return box_size_; }
    double radius() const { return radius_; }
    double diameter() const { return diameter_; }
    double tolerance() const { return tolerance_; }

    /// Contact of a pair under the rule "one": pairs deeper than the tolerance pass through each other.
    PairContact<double> contact(const Disc& p, const Disc& q) const {
        return pair_contact(p, q, diameter_, tolerance_);
    }

    /// In-step time of the disc's one wall candidate of micro-step m, or `never`. The earlier axis gives it.
    double wall_time(const Disc& disc, double m) const {
        return std::min(axis_time(disc.x, disc.vx, disc.tau, m), axis_time(disc.y, disc.vy, disc.tau, m));
    }

    /// Bounce `disc` at in-step time t = wall_time(disc, m); a corner reverses both axes and counts once.
    void bounce(Disc& disc, double m, double t) const {
        const double tx = axis_time(disc.x, disc.vx, disc.tau, m);
        const double ty = axis_time(disc.y, disc.vy, disc.tau, m);
        advance(disc, m + t);
        const bool x_reverses = tx == t || touches_wall(disc.x, disc.vx);
        const bool y_reverses = ty == t || touches_wall(disc.y, disc.vy);
        if (x_reverses) disc.vx = -disc.vx;
        if (y_reverses) disc.vy = -disc.vy;
        disc.wall_collisions += 1;
        stop_at_wall(disc, m, t);
    }

    /// Collide the pair at in-step time t; `p` has the lower id.
    void collide(Disc& p, Disc& q, double m, double t) const {
        collide_at(p, q, m + t);
        stop_at_wall(p, m, t);
        stop_at_wall(q, m, t);
    }

    // The rule "all". Times count from the last sync; there is no band, no stop and no micro-step.

    /// Contact of a pair that is free to move: touching or overlapping pairs that approach collide at once.
    PairContact<double> exact_contact(const Disc& p, const Disc& q) const { return pair_contact(p, q, diameter_, never); }

    /// When the disc meets the wall that it approaches along x or y; infinite or `never` if it does not.
    double x_wall_time(const Disc& disc) const { return exact_axis_time(disc.x, disc.vx, disc.tau); }
    double y_wall_time(const Disc& disc) const { return exact_axis_time(disc.y, disc.vy, disc.tau); }

    /// Whether a wall might be met by `time`: never false where x_wall_time or y_wall_time is not later than that.
    bool may_meet_wall(const Disc& disc, double time) const {
        const double x = disc.x_at(time), y = disc.y_at(time);
        // The last term: a time is rounded, and a fast disc goes some way in that.
        const double margin = tolerance_ + 0x1p-50 * time * std::max(std::fabs(disc.vx), std::fabs(disc.vy));
        const double inner_low = low() + margin, inner_high = high() - margin;
        return !(x > inner_low && x < inner_high && y > inner_low && y < inner_high);
    }

    static void bounce_x_at(Disc& disc, double time) {
        advance(disc, time);
        disc.vx = -disc.vx;
        disc.wall_collisions += 1;
    }
    static void bounce_y_at(Disc& disc, double time) {
        advance(disc, time);
        disc.vy = -disc.vy;
        disc.wall_collisions += 1;
    }

    /// Collide the pair; `p` has the lower id.
    static void collide_at(Disc& p, Disc& q, double time) {
        advance(p, time);
        advance(q, time);
        const double ex = q.x - p.x, ey = q.y - p.y;
        const double wx = q.vx - p.vx, wy = q.vy - p.vy;
        const double k = (wx * ex + wy * ey) / (ex * ex + ey * ey);
        p.vx += k * ex;
        p.vy += k * ey;
        q.vx -= k * ex;
        q.vy -= k * ey;
        p.pair_collisions += 1;
        q.pair_collisions += 1;
    }

    static void advance(Disc& disc, double time) {
        disc.x = disc.x_at(time);
        disc.y = disc.y_at(time);
        disc.tau = time;
    }

private:
    /// Only the wall being approached counts; a slow disc inside the band bounces at t = 1 without touching.
    double axis_time(double x, double v, double tau, double m) const {
        const double at_end = x + v * ((m + 1) - tau);
        if (v < 0 && at_end < radius_ + band_) return std::clamp((tau - m) + (low() - x) / v, 0.0, 1.0);
        if (v > 0 && at_end > high() - band_) return std::clamp((tau - m) + (high() - x) / v, 0.0, 1.0);
        return never;
    }

    double exact_axis_time(double x, double v, double tau) const {
        if (v == 0) return never;
        const double delay = ((v < 0 ? low() : high()) - x) / v;
        return tau + (delay > 0 ? delay : 0);
    }

    bool touches_wall(double x, double v) const {
        return (v < 0 && x <= radius_ + band_) || (v > 0 && x >= high() - band_);
    }

    /// A disc that would leave the box before the micro-step ends waits at the wall; it bounces in the next one.
    void stop_at_wall(Disc& disc, double m, double t) const {
        const double rest = 1 - t;
        const double stop = std::min(axis_stop(disc.x, disc.vx, rest), axis_stop(disc.y, disc.vy, rest));
        if (stop == never) return;
        disc.x += disc.vx * stop;
        disc.y += disc.vy * stop;
        disc.tau = m + 1;
    }

    double axis_stop(double x, double v, double rest) const {
        const double at_end = x + v * rest;
        if (v < 0 && at_end < low()) return std::max((low() - x) / v, 0.0);
        if (v > 0 && at_end > high()) return std::max((high() - x) / v, 0.0);
        return never;
    }

    double low() const { return radius_; }
    double high() const { return box_size_ - radius_; }

    double box_size_, radius_, diameter_, band_, tolerance_;
};

} // namespace carrom
