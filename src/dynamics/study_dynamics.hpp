// SPDX-License-Identifier: BSD-3-Clause
// Plain dynamics with less accurate arithmetic, for the accuracy study
// (docs/understanding/accuracy.md): single precision, the naive contact formula, or
// both. Runs use PlainDynamics unless a scene asks for this one.
//
// `Real` is the precision of states and of computation. A float's state is stored in
// doubles of the same value, so the rest of the program need not know. The formula is
// chosen when the program runs.
//
// Such a dynamics finds contacts where discs do not touch, and misses some. The search goes only
// where discs touch, within a margin, and how far depends on ranks and threads. So a contact counts
// only within a fixed margin, `slack`: then all distributions find the same.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <type_traits>

#include "dynamics/naive_contact.hpp"
#include "dynamics/plain_dynamics.hpp"

namespace carrom {

enum class ContactFormula { stable, naive, naive_contracted };

/// A disc's numbers in the precision of the computation.
template <class Real> struct RoundedState {
    Real x, y, vx, vy, tau;

    explicit RoundedState(const DiscState& disc)
        : x(static_cast<Real>(disc.x)), y(static_cast<Real>(disc.y)),
          vx(static_cast<Real>(disc.vx)), vy(static_cast<Real>(disc.vy)),
          tau(static_cast<Real>(disc.tau)) {}
    Real x_at(Real time) const { return x + vx * (time - tau); }
    Real y_at(Real time) const { return y + vy * (time - tau); }
};

/// Takes the parts without arithmetic from the plain dynamics: clock, frame, negative answers.
template <class Real> class StudyDynamics : public PlainDynamics {
public:
    static constexpr bool is_for_study = true;
    /// If discs have no room, rounding moves them on in time now and then, so an
    /// endless cascade is not at a single time.
    static constexpr double cascade_interval = 0x1p-3;

    StudyDynamics(const Box& box, double radius, ContactFormula formula)
        : PlainDynamics(Box(real(box.x), real(box.y)), real(radius)), formula_(formula),
          x_walls_(real(box.x), real(radius), static_cast<Real>(1e-8) * real(radius)),
          y_walls_(real(box.y), real(radius), static_cast<Real>(1e-8) * real(radius)),
          sigma_(2 * real(radius)),
          overlap_(std::max(static_cast<Real>(1e-12) * sigma_,
                            16 * std::numeric_limits<Real>::epsilon() * real(box.longest()))),
          slack_(rounding() + (formula == ContactFormula::stable ? 0 : misplacement() * radius_)) {}

    bool parts_overlaps() const { return formula_ == ContactFormula::stable; }
    double tolerance() const { return overlap_; }
    double slack() const { return slack_; }
    double search_diameter() const { return diameter() + 2 * slack_; }

    /// Rounds a state to its precision.
    static void round(DiscState& disc) {
        for (double* number : {&disc.x, &disc.y, &disc.vx, &disc.vy, &disc.tau})
            *number = real(*number);
    }
    static void advance(DiscState& disc, double time) {
        const RoundedState<Real> flight(disc);
        disc.x = flight.x_at(real(time));
        disc.y = flight.y_at(real(time));
        disc.tau = real(time);
    }

    PairContact<Real> contact(const DiscState& p, const DiscState& q) const {
        const PairContact<Real> found = contact_of(p, q, overlap_);
        const double time = static_cast<double>(found.base) + static_cast<double>(found.delay);
        return is_near(p, q, time) ? found : PairContact<Real>{};
    }
    void collide(DiscState& p, DiscState& q, double m, double t) const {
        collide_at(p, q, real(m) + real(t));
        stop_at_wall(p, m, t);
        stop_at_wall(q, m, t);
    }
    double wall_time(const DiscState& disc, double m) const {
        return std::min(x_time(disc, m), y_time(disc, m));
    }
    void bounce(DiscState& disc, double m, double t, double* /*spin*/ = nullptr) const {
        const MetWalls met = reach_walls(disc, m, t);
        if (met.at_x) disc.vx = -disc.vx;
        if (met.at_y) disc.vy = -disc.vy;
        disc.wall_collisions += 1;
        stop_at_wall(disc, m, t);
    }
    MetWalls met_walls(const DiscState& before, double m, double t) const {
        DiscState disc = before;
        return reach_walls(disc, m, t);
    }

    PairContact<Real> event_contact(const DiscState& p, const DiscState& q) const {
        const PairContact<Real> found = contact_of(p, q, RestingWalls<Real>::never);
        return is_near(p, q, found.base + found.delay) ? found : PairContact<Real>{};
    }
    static Loss collide_at(DiscState& p, DiscState& q, double time) {
        advance(p, time);
        advance(q, time);
        const RoundedState<Real> a(p), b(q);
        const Real ex = b.x - a.x, ey = b.y - a.y, wx = b.vx - a.vx, wy = b.vy - a.vy;
        const Real k = (wx * ex + wy * ey) / (ex * ex + ey * ey);
        p.vx = a.vx + k * ex;
        p.vy = a.vy + k * ey;
        q.vx = b.vx - k * ex;
        q.vy = b.vy - k * ey;
        p.pair_collisions += 1;
        q.pair_collisions += 1;
        return {};
    }
    double x_wall_time(const DiscState& disc) const {
        const RoundedState<Real> d(disc);
        return d.tau + x_walls_.delay(d.x, d.vx);
    }
    double y_wall_time(const DiscState& disc) const {
        const RoundedState<Real> d(disc);
        return d.tau + y_walls_.delay(d.y, d.vy);
    }
    bool may_meet_wall(const DiscState& disc, double time) const {
        constexpr double rounding_of_time = is_rounded ? 0x1p-21 : time_rounding;
        const double x = disc.x_at(time), y = disc.y_at(time);
        const double margin = tolerance() + rounding() +
                              rounding_of_time * time *
                                  std::max(std::fabs(disc.vx), std::fabs(disc.vy));
        return !(x > x_walls_.low() + margin && x < x_walls_.high() - margin &&
                 y > y_walls_.low() + margin && y < y_walls_.high() - margin);
    }
    static Loss bounce_x_at(DiscState& disc, double time, double* /*spin*/ = nullptr) {
        advance(disc, time);
        disc.vx = -disc.vx;
        disc.wall_collisions += 1;
        return {};
    }
    static Loss bounce_y_at(DiscState& disc, double time, double* /*spin*/ = nullptr) {
        advance(disc, time);
        disc.vy = -disc.vy;
        disc.wall_collisions += 1;
        return {};
    }

private:
    static constexpr bool is_rounded = std::is_same_v<Real, float>;

    static Real real(double number) { return static_cast<Real>(number); }

    double rounding() const { return is_rounded ? 0x1p-18 * box().longest() : 0; }

    /// How far from touching, in diameters, a formula that loses digits finds contacts. At a
    /// distance of d diameters rounding u moves B^2 - 4 A C by some u (2 d v)^2. So a grazing
    /// contact moves along the flight by the root of that over 2 v, and its distance by the square.
    /// Where that is half a diameter and more the contact counts as lost.
    double misplacement() const {
        const double longest = std::numbers::sqrt2 * box().longest() / diameter();
        return std::min(0.5, 2.5 * std::numeric_limits<Real>::epsilon() * longest * longest);
    }

    PairContact<Real> contact_of(const DiscState& p, const DiscState& q,
                                 Real deepest_overlap) const {
        const RoundedState<Real> a(p), b(q);
        if (formula_ == ContactFormula::stable) return pair_contact(a, b, sigma_, deepest_overlap);
        const Real base = std::max(a.tau, b.tau);
        return {base, naive_contact_delay(b.x_at(base) - a.x_at(base), b.y_at(base) - a.y_at(base),
                                          b.vx - a.vx, b.vy - a.vy, sigma_,
                                          formula_ == ContactFormula::naive_contracted)};
    }

    /// Whether the discs, advanced to that time in double precision, are within the margin.
    bool is_near(const DiscState& p, const DiscState& q, double time) const {
        const double dx = q.x_at(time) - p.x_at(time), dy = q.y_at(time) - p.y_at(time);
        const double farthest = search_diameter() - rounding();
        return dx * dx + dy * dy <= farthest * farthest;
    }

    Real x_time(const DiscState& disc, double m) const {
        const RoundedState<Real> d(disc);
        return x_walls_.time(d.x, d.vx, d.tau, real(m));
    }
    Real y_time(const DiscState& disc, double m) const {
        const RoundedState<Real> d(disc);
        return y_walls_.time(d.y, d.vy, d.tau, real(m));
    }
    MetWalls reach_walls(DiscState& disc, double m, double t) const {
        const Real to_x = x_time(disc, m), to_y = y_time(disc, m);
        advance(disc, real(m) + real(t));
        const RoundedState<Real> d(disc);
        return {to_x == real(t) || x_walls_.touches(d.x, d.vx),
                to_y == real(t) || y_walls_.touches(d.y, d.vy)};
    }
    void stop_at_wall(DiscState& disc, double m, double t) const {
        const RoundedState<Real> d(disc);
        const Real rest = 1 - real(t);
        const Real stop = std::min(x_walls_.stop(d.x, d.vx, rest), y_walls_.stop(d.y, d.vy, rest));
        if (stop == RestingWalls<Real>::never) return;
        disc.x = d.x + d.vx * stop;
        disc.y = d.y + d.vy * stop;
        disc.tau = m + 1;
    }

    ContactFormula formula_;
    RestingWalls<Real> x_walls_, y_walls_;
    Real sigma_, overlap_;
    double slack_;
};

} // namespace carrom
