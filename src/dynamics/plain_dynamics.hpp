// SPDX-License-Identifier: BSD-3-Clause
// The laws of a scene that names no effect: free flight, elastic pairs, four elastic walls
// (docs/method.md, section 3).
//
// Kernels take the law as a template argument and ask it what a disc does; another set of effects
// is another law with the same members, chosen once at start. In the time-stepped method times t
// are in-step times of the micro-step [m, m+1]; m is exact in a double.
//
// `Real` is what states are rounded to and what is computed in, `Formula` how contacts are found.
// Both are knobs of the accuracy study (docs/accuracy.md); PlainDynamics is what runs unless a
// scene asks for another. A float's states are stored as doubles of the same value, so that all
// else need not know.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <type_traits>

#include "core/disc.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/plain_boundaries.hpp"
#include "geometry/naive_contact.hpp"
#include "geometry/pair_contact.hpp"

namespace carrom {

/// What the contact formula asks of a disc, in the precision that it computes in.
template <class Real> struct RoundedState {
    Real x, y, vx, vy, tau;

    explicit RoundedState(const Disc& disc)
        : x(static_cast<Real>(disc.x)), y(static_cast<Real>(disc.y)),
          vx(static_cast<Real>(disc.vx)), vy(static_cast<Real>(disc.vy)),
          tau(static_cast<Real>(disc.tau)) {}
    Real x_at(Real time) const { return x + vx * (time - tau); }
    Real y_at(Real time) const { return y + vy * (time - tau); }
};

template <class Real, class Formula> class BasicPlainDynamics {
public:
    static constexpr double never = std::numeric_limits<double>::infinity();
    static constexpr bool is_double = std::is_same_v<Real, double>;
    /// Whether contacts may be found where discs do not touch, or be missed.
    static constexpr bool is_loose = !is_double || !Formula::keeps_digits;
    /// Whether discs that overlap part when they approach; else they pass through each other.
    static constexpr bool parts_overlaps = Formula::parts_overlaps;
    /// Whether discs meet each other at all.
    static constexpr bool has_pairs = true;
    /// Whether there may be bodies in the box beside its walls.
    static constexpr bool may_have_obstacles = false;
    static constexpr bool has_obstacles() { return false; }
    static constexpr bool has_walls() { return true; }
    /// Whether discs may leave the box.
    static constexpr bool may_lose_discs = false;
    /// Whether a wall reverses a velocity across it and does nothing else to a disc.
    static constexpr bool has_mirror_walls = true;
    /// Whether discs differ in radius and mass.
    static constexpr bool has_species = false;
    /// Whether they turn, and `collide` and `collide_at` take their spins as well.
    static constexpr bool has_spin = false;
    /// Whether discs have images (periodic_law.hpp).
    static constexpr bool is_periodic = false;
    /// In the event-driven method: more than some thousand collisions of a disc in so many
    /// micro-steps are without end. Where discs have no room, loose laws move them on by a rounding
    /// of time now and then, which is not at one time and has no end either.
    static constexpr double one_time = is_loose ? 0x1p-3 : 0x1p-40;

    BasicPlainDynamics(double box_size, double radius)
        : box_size_(static_cast<Real>(box_size)), radius_(static_cast<Real>(radius)),
          diameter_(2 * radius_), band_(static_cast<Real>(1e-8) * radius_),
          tolerance_(std::max(static_cast<Real>(1e-12) * diameter_,
                              16 * std::numeric_limits<Real>::epsilon() * box_size_)),
          slack_(rounding() + (Formula::keeps_digits ? 0 : misplacement() * this->radius())) {}

    /// What engines ask of walls, clock and frame.
    PlainBoundaries boundaries() const { return PlainBoundaries(box_size()); }
    /// From now on times count from micro-step `n` of the scene.
    void begin_interval(std::int64_t /*n*/) {}

    double box_size() const { return box_size_; }
    double radius() const { return radius_; }
    double diameter() const { return diameter_; }
    double tolerance() const { return tolerance_; }
    /// What a radius has to be longer by in a search, for no contact to be lost: for what rounding
    /// to `Real` moves discs by, and for contacts that `Formula` finds too early or too late.
    double slack() const {
        if constexpr (is_loose) return slack_;
        return 0;
    }
    double search_diameter() const { return diameter() + 2 * slack(); }

    /// The same law for a pair whose radii have the sum `diameter`, or for a disc of another
    /// `radius` at walls. Bands and tolerances stay.
    BasicPlainDynamics with_sizes(Real radius, Real diameter) const {
        BasicPlainDynamics dynamics = *this;
        dynamics.radius_ = radius;
        dynamics.diameter_ = diameter;
        return dynamics;
    }

    /// Rounds a state to the precision that it is to have.
    static void round(Disc& disc) {
        for (double* number : {&disc.x, &disc.y, &disc.vx, &disc.vy, &disc.tau})
            *number = static_cast<Real>(*number);
    }

    /// Contact of a pair in the time-stepped method: pairs deeper than the tolerance pass through
    /// each other.
    PairContact<Real> contact(const Disc& p, const Disc& q) const {
        const PairContact<Real> found = contact(p, q, tolerance_);
        if constexpr (is_loose) {
            if (!is_near(p, q, static_cast<double>(found.base) + static_cast<double>(found.delay)))
                return {};
        }
        return found;
    }

    /// In-step time of the disc's one wall candidate of micro-step m, or `never`. The earlier axis
    /// gives it.
    double wall_time(const Disc& disc, double m) const {
        return std::min(axis_time(disc.x, disc.vx, disc.tau, m),
                        axis_time(disc.y, disc.vy, disc.tau, m));
    }

    /// Bounce `disc` at in-step time t = wall_time(disc, m); a corner reverses both axes and counts
    /// once.
    void bounce(Disc& disc, double m, double t) const {
        const Real tx = axis_time(disc.x, disc.vx, disc.tau, m);
        const Real ty = axis_time(disc.y, disc.vy, disc.tau, m);
        advance(disc, real(m) + real(t));
        const bool x_reverses = tx == real(t) || touches_wall(disc.x, disc.vx);
        const bool y_reverses = ty == real(t) || touches_wall(disc.y, disc.vy);
        if (x_reverses) disc.vx = -disc.vx;
        if (y_reverses) disc.vy = -disc.vy;
        disc.wall_collisions += 1;
        stop_at_wall(disc, m, t);
    }

    struct MetWalls {
        bool at_x = false, at_y = false;
    };
    /// Which walls that bounce is at, for those who ask.
    MetWalls met_walls(const Disc& before, double m, double t) const {
        Disc disc = before;
        const Real tx = axis_time(disc.x, disc.vx, disc.tau, m),
                   ty = axis_time(disc.y, disc.vy, disc.tau, m);
        advance(disc, real(m) + real(t));
        return {tx == real(t) || touches_wall(disc.x, disc.vx),
                ty == real(t) || touches_wall(disc.y, disc.vy)};
    }

    /// Collide the pair at in-step time t; `p` has the lower id.
    void collide(Disc& p, Disc& q, double m, double t) const {
        collide_at(p, q, real(m) + real(t));
        stop_at_wall(p, m, t);
        stop_at_wall(q, m, t);
    }

    // The event-driven method. Times count from the last sync; there is no band, no stop and no
    // micro-step.

    /// Contact of a pair that is free to move: touching or overlapping pairs that approach collide
    /// at once.
    [[gnu::always_inline]] PairContact<Real> event_contact(const Disc& p, const Disc& q) const {
        const PairContact<Real> found = contact(p, q, static_cast<Real>(never));
        if constexpr (is_loose) {
            if (!is_near(p, q, found.base + found.delay)) return {};
        }
        return found;
    }

    /// When the disc meets the wall that it approaches along x or y; infinite or `never` if it does
    /// not.
    double x_wall_time(const Disc& disc) const {
        return event_axis_time(disc.x, disc.vx, disc.tau);
    }
    double y_wall_time(const Disc& disc) const {
        return event_axis_time(disc.y, disc.vy, disc.tau);
    }

    /// Whether a wall might be met by `time`: never false where x_wall_time or y_wall_time is not
    /// later than that.
    bool may_meet_wall(const Disc& disc, double time) const {
        const double x = disc.x_at(time), y = disc.y_at(time);
        // The last term: a time is rounded, and a fast disc goes some way in that.
        const double margin = tolerance() + rounding() +
                              time_rounding * time *
                                  std::max(std::fabs(disc.vx), std::fabs(disc.vy));
        const double inner_low = low() + margin, inner_high = high() - margin;
        return !(x > inner_low && x < inner_high && y > inner_low && y < inner_high);
    }

    /// A disc that is inside at some time in [begin, end], and within these walls at the end, has
    /// met none in between.
    Extent walls_between(double /*begin*/, double /*end*/) const {
        return {0, box_size(), 0, box_size()};
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
    static void collide_at(Disc& p, Disc& q, double time) { collide_with(p, q, time, 1); }

    static void advance(Disc& disc, double time) {
        const RoundedState<Real> flight(disc);
        disc.x = flight.x_at(real(time));
        disc.y = flight.y_at(real(time));
        disc.tau = real(time);
    }

    // What wall_time, bounce and collide are made of, for other laws.

    /// Only the wall being approached counts; a slow disc inside the band bounces at t = 1 without
    /// touching.
    [[gnu::always_inline]] Real axis_time(double x, double v, double tau, double m) const {
        const Real at_end = real(x) + real(v) * ((real(m) + 1) - real(tau));
        if (v < 0 && at_end < radius_ + band_)
            return std::clamp((real(tau) - real(m)) + (low() - real(x)) / real(v), Real{0},
                              Real{1});
        if (v > 0 && at_end > high() - band_)
            return std::clamp((real(tau) - real(m)) + (high() - real(x)) / real(v), Real{0},
                              Real{1});
        return real(never);
    }

    bool touches_wall(double x, double v) const {
        return (v < 0 && x <= radius_ + band_) || (v > 0 && x >= high() - band_);
    }

    /// A disc that would leave the box before the micro-step ends waits at the wall; it bounces in
    /// the next one.
    [[gnu::always_inline]] void stop_at_wall(Disc& disc, double m, double t) const {
        const Real rest = 1 - real(t);
        const Real stop = std::min(axis_stop(disc.x, disc.vx, rest),
                                   axis_stop(disc.y, disc.vy, rest));
        if (stop == real(never)) return;
        disc.x = real(disc.x) + real(disc.vx) * stop;
        disc.y = real(disc.y) + real(disc.vy) * stop;
        disc.tau = m + 1;
    }

    /// How far into the `rest` of a micro-step a disc would leave the box.
    [[gnu::always_inline]] Real axis_stop(double x, double v, Real rest) const {
        const Real at_end = real(x) + real(v) * rest;
        if (v < 0 && at_end < low()) return std::max((low() - real(x)) / real(v), Real{0});
        if (v > 0 && at_end > high()) return std::max((high() - real(x)) / real(v), Real{0});
        return real(never);
    }

protected:
    /// `impulse` in units of that of an elastic contact of equal masses, of which p and q take
    /// their shares; multiplying by 1 leaves every bit, and no instruction.
    [[gnu::always_inline]] static void collide_with(Disc& p, Disc& q, double time, Real impulse,
                                                    Real p_share = 1, Real q_share = 1) {
        advance(p, time);
        advance(q, time);
        push_apart(p, q, real(q.x) - real(p.x), real(q.y) - real(p.y), impulse, p_share, q_share);
    }

    /// What a contact does to the velocities of discs at the separation (ex, ey), and to their
    /// counters.
    [[gnu::always_inline]] static void push_apart(Disc& p, Disc& q, Real ex, Real ey, Real impulse,
                                                  Real p_share = 1, Real q_share = 1) {
        const Real wx = real(q.vx) - real(p.vx), wy = real(q.vy) - real(p.vy);
        const Real k = impulse * ((wx * ex + wy * ey) / (ex * ex + ey * ey));
        p.vx = real(p.vx) + k * p_share * ex;
        p.vy = real(p.vy) + k * p_share * ey;
        q.vx = real(q.vx) - k * q_share * ex;
        q.vy = real(q.vy) - k * q_share * ey;
        p.pair_collisions += 1;
        q.pair_collisions += 1;
    }

    static constexpr double time_rounding = is_double ? 0x1p-50 : 0x1p-21;

    /// How far from touching, in diameters, a formula that loses digits finds contacts. At a
    /// distance of d diameters rounding u moves B^2 - 4 A C by some u (2 d v)^2, a grazing
    /// contact's place along the flight by the root of that over 2 v, and the distance by its
    /// square. Where that is half a diameter and more the contact is taken for lost.
    double misplacement() const {
        const double longest = std::numbers::sqrt2 * box_size() / diameter();
        return std::min(0.5, 2.5 * std::numeric_limits<Real>::epsilon() * longest * longest);
    }
    double rounding() const { return is_double ? 0 : 0x1p-18 * box_size(); }

    static Real real(double number) { return static_cast<Real>(number); }

    [[gnu::always_inline]] PairContact<Real> contact(const Disc& p, const Disc& q,
                                                     Real deepest_overlap) const {
        if constexpr (is_double)
            return pair_contact(p, q, diameter_, deepest_overlap, Formula{});
        else
            return pair_contact(RoundedState<Real>(p), RoundedState<Real>(q), diameter_,
                                deepest_overlap, Formula{});
    }

    /// A search looks where discs touch, with a margin, and how far depends on the machine's shape.
    /// So that the shape has no say in what is found, a contact counts only where the discs, taken
    /// to that time in double precision, are within it.
    bool is_near(const Disc& p, const Disc& q, double time) const {
        const double dx = q.x_at(time) - p.x_at(time), dy = q.y_at(time) - p.y_at(time);
        const double farthest = search_diameter() - rounding();
        return dx * dx + dy * dy <= farthest * farthest;
    }

    double event_axis_time(double x, double v, double tau) const {
        if (v == 0) return never;
        const Real delay = ((v < 0 ? low() : high()) - real(x)) / real(v);
        return real(tau) + (delay > 0 ? delay : 0);
    }

    Real low() const { return radius_; }
    Real high() const { return box_size_ - radius_; }

    Real box_size_, radius_, diameter_, band_, tolerance_;
    double slack_; ///< of loose laws
};

/// The law that the promise of the same bits is about.
using PlainDynamics = BasicPlainDynamics<double, StableContact>;

using NaiveDynamics = BasicPlainDynamics<double, NaiveContact<false>>;
using ContractedDynamics = BasicPlainDynamics<double, NaiveContact<true>>;
using SingleDynamics = BasicPlainDynamics<float, StableContact>;
using SingleNaiveDynamics = BasicPlainDynamics<float, NaiveContact<false>>;
using SingleContractedDynamics = BasicPlainDynamics<float, NaiveContact<true>>;

} // namespace carrom
