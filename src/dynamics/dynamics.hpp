// SPDX-License-Identifier: BSD-3-Clause
// What discs do: a space, bodies and a law, with what surrounds discs beside them.
//
//        space (space.hpp)         which image a disc meets, and where it is
//        bodies (bodies.hpp)       radius, mass, speed of the surface
//        law (law.hpp)             what a meeting does to velocities and spins
//      + arithmetic                precision and formula of contacts (arithmetic.hpp)
//        sides, obstacles, flight  what else discs meet, and in which frame (surroundings.hpp)
//
// Each is a value with a small concept in its own header; here stands the text that uses them,
// once. Kernels take a dynamics as a template argument. What is asked for each pair is compiled,
// and all else is decided when the program runs, so that few combinations are enough
// (all_dynamics.hpp).
//
// Lengths are the scene's. Times are micro-steps since the last sync, on the dynamics' own clock.
// Places and velocities are those of its frame. Answers depend on the stored states alone, so all
// ranks get the same bits. An effect whose parameters make it none gives the plain bits.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "core/axis.hpp"
#include "core/flight_integral.hpp"
#include "core/frame.hpp"
#include "dynamics/bodies.hpp"
#include "dynamics/law.hpp"
#include "dynamics/never.hpp"
#include "dynamics/obstacles.hpp"
#include "dynamics/resting_walls.hpp"
#include "dynamics/space.hpp"
#include "dynamics/surroundings.hpp"

namespace carrom {

template <Space InSpace, Bodies OfBodies, class Surroundings = SurroundingsOfEffects>
class Dynamics {
public:
    using Arithmetic = typename Surroundings::Arithmetic;
    using Real = typename Arithmetic::Real;

    // What can happen in a scene. Kernels compile no code for what cannot.
    static constexpr bool have_effects = Surroundings::have_effects,
                          is_periodic = InSpace::is_periodic,
                          has_moving_images = InSpace::has_moving_images,
                          has_species = OfBodies::have_species,
                          has_mirror_walls = !have_effects, // they only reverse a velocity
        may_have_obstacles = have_effects && !OfBodies::grow,
                          may_lose_discs = have_effects && !is_periodic, // through open sides
        is_for_study = Arithmetic::is_for_study;
    /// Thousands of collisions of a disc within this many micro-steps are an endless cascade.
    static constexpr double cascade_interval = std::max(OfBodies::cascade_interval,
                                                        Arithmetic::cascade_interval);
    static constexpr double never = carrom::never;

    /// `effects` per micro-step; `radius` is the largest one.
    Dynamics(const Box& box, double radius, const Effects& effects = {},
             ContactFormula formula = ContactFormula::stable)
        : arithmetic_(box, radius, formula), box_(Arithmetic::rounded(box)),
          radius_(Arithmetic::rounded(radius)),
          band_(static_cast<Real>(1e-8) * static_cast<Real>(radius)),
          tolerance_(Arithmetic::tolerance(box_, 2 * radius_)), space_(box_, effects),
          species_(effects.species, radius_, effects.swap.is_any()),
          bodies_(radius_, effects, species_.view()), law_(effects, radius_),
          sides_(box_, radius_, effects), flight_(effects) {
        if (may_have_obstacles && effects.obstacles.are_any())
            obstacles_ = std::make_shared<const Obstacles>(box_, radius_, effects);
    }

    /// From now on times count from micro-step `n` of the scene.
    void begin_interval(std::int64_t n) {
        space_.begin_interval(n);
        bodies_.begin_interval(n);
        sides_.begin_interval(n);
        flight_.begin_interval(static_cast<double>(n));
    }

    // Questions about the scene.

    bool has_pairs() const { return !have_effects || law_.has_pairs(); }
    bool has_spin() const { return have_effects && law_.has_spin(); }
    /// Collisions of pairs keep the kinetic energy.
    bool has_elastic_pairs() const {
        return !have_effects || (law_.is_elastic() && !OfBodies::grow);
    }
    /// Discs can meet walls or obstacles.
    bool has_walls() const { return space_.has_sides() || has_obstacles(); }
    bool has_obstacles() const { return may_have_obstacles && obstacles_ != nullptr; }
    bool has_open_sides() const { return may_lose_discs && sides_.are_any_open(); }
    bool parts_overlaps() const { return arithmetic_.parts_overlaps(); }

    // Sizes, of radii that have not grown. The radius is the largest one.

    const Box& box() const { return box_; }
    double radius() const { return radius_; }
    double diameter() const { return 2 * radius_; }
    double tolerance() const { return tolerance_; }
    /// The largest gap between discs in a contact.
    double slack() const { return space_.slack() + arithmetic_.slack(); }
    /// The largest distance of centres in a contact.
    double search_diameter() const { return diameter() + 2 * slack(); }
    double growth_at(double time) const { return bodies_.growth_at(time); }
    const SpeciesTable& species_table() const { return species_; }
    double mass_of(const DiscState& disc) const { return bodies_.of(disc).mass; }

    // Speeds that searches allow for: the disc's own, and that of its image in the box at a time.

    double squared_speed(const DiscState& disc) const { return space_.squared_speed(disc); }
    double squared_speed_at(const DiscState& disc, double time) const {
        return space_.squared_speed_at(disc, time);
    }
    const Periods& periods() const
        requires is_periodic
    {
        return space_.periods();
    }
    /// Brings a state that a sync has just rewritten into the box.
    void wrap(DiscState& disc) const
        requires is_periodic
    {
        space_.wrap(disc);
    }

    // Clock and frame, in which discs fly straight. Times are on the clock.

    double clock_at(double micro_steps) const { return flight_.clock_at(micro_steps); }
    double micro_steps_at(double clock) const { return flight_.micro_steps_at(clock); }
    Frame frame_at(double time) const { return flight_.at(time); }
    bool has_own_frame() const { return flight_.is_any(); }
    double slowing_at(double time) const { return flight_.slowing_at(time); }
    /// The state in the frame of the next interval.
    void restart_frame(DiscState& disc, double time) const { flight_.restart(disc, time); }
    double jump_at(Axis axis, double time) const { return flight_.jump_at(axis, time); }
    double speed_gained_at(double time) const { return flight_.speed_gained_at(time); }
    /// See StressSums. Where images move, kinetic stress is relative to the flow, and changes along
    /// a flight, so it is sampled.
    FlightIntegral flight_integral_at(double time) const {
        if constexpr (has_moving_images) return {};
        return flight_.flight_integral_at(time);
    }
    double pair_weight_at(double time) const {
        return has_moving_images ? 0 : flight_.pair_weight_at(time);
    }
    CARROM_DEVICE static void advance(DiscState& disc, double time) {
        Arithmetic::advance(disc, time);
    }
    static void round(DiscState& disc)
        requires is_for_study
    {
        Arithmetic::round(disc);
    }

    // Pairs.

    /// The contact of two discs in free flight (pair_contact.hpp). Discs that overlap by more than
    /// `deepest_overlap` have none.
    [[gnu::always_inline]] CARROM_DEVICE PairContact<Real> contact(const DiscState& p,
                                                                   const DiscState& q,
                                                                   double deepest_overlap) const {
        if (may_lose_discs && (p.has_departed() || q.has_departed())) return {};
        const typename Arithmetic::State a(p), b(q);
        const Real base = std::max(a.tau, b.tau);
        const Encounter<Real> met = space_.see(a, b, b.x_at(base) - a.x_at(base),
                                               b.y_at(base) - a.y_at(base), base);
        const PairContact<Real> found{
            base, bodies_.delay(arithmetic_, a, b, met, base, static_cast<Real>(deepest_overlap))};
        return arithmetic_.counts(p, q, found) ? found : PairContact<Real>{};
    }
    /// Carries out the contact at `time`; `p` has the lower id, and the last collision of either
    /// disc was `since` before.
    [[gnu::always_inline]] CARROM_DEVICE Loss collide(DiscState& p, DiscState& q, double time,
                                                      double since, const Spins& spins = {}) const {
        advance(p, time);
        advance(q, time);
        const typename Arithmetic::State a(p), b(q);
        const auto at = static_cast<Real>(time);
        const Encounter<Real> met = space_.see(a, b, b.x - a.x, b.y - a.y, at);
        const Loss loss = law_.meet(p, q, bodies_.surfaces(met, at), bodies_.of(p), bodies_.of(q),
                                    since, spins);
        if (have_effects) p.has_collided = q.has_collided = 1;
        return loss;
    }
    CARROM_DEVICE static double since_collision_of(const DiscState& p, const DiscState& q,
                                                   double time) {
        return std::min(since_collision(p, time), since_collision(q, time));
    }
    /// From p to q, which are both at the place of their collision.
    Separation separation(const DiscState& p, const DiscState& q) const {
        const Encounter<double> met = space_.see(p, q, q.x - p.x, q.y - p.y, p.tau);
        return {met.ex, met.ey};
    }
    /// From p to q, which are both at `time`, or fly there.
    Separation separation_at(const DiscState& p, const DiscState& q, double time) const {
        const Encounter<double> met = space_.see(p, q, q.x_at(time) - p.x_at(time),
                                                 q.y_at(time) - p.y_at(time), time);
        return {met.ex, met.ey};
    }

    // Sides. `spin`, here and below, is null where discs do not turn.

    Extent extent_at(double time) const { return sides_.extent_at(time); } ///< where walls are
    /// A disc inside at some time in between, and within these walls at the end, has met none.
    Extent walls_between(double begin, double end) const {
        return sides_.walls_between(begin, end);
    }
    /// When the disc meets a side of this axis, or `never`.
    double wall_time(const DiscState& disc, Axis axis) const {
        return sides_.wall_time(disc, axis, bodies_.at(disc, disc.tau));
    }
    /// False only if neither wall time is up to `time`.
    bool may_meet_wall(const DiscState& disc, double time) const {
        const Body body = bodies_.at(disc, disc.tau);
        // The product allows for rounded times, in which a fast disc flies some way.
        const double fastest = std::max(std::fabs(disc.vx), std::fabs(disc.vy)) +
                               (speed_gained_at(time) + body.growth);
        const double margin = (tolerance_ + arithmetic_.place_rounding()) +
                              Arithmetic::time_rounding * time * fastest;
        return sides_.may_meet(disc, time, margin, body);
    }
    /// Carries out the collision of `time` = wall_time(disc, axis).
    Loss bounce(DiscState& disc, Axis axis, double time, double* spin = nullptr) const {
        return sides_.bounce(disc, axis, time, bodies_.at(disc, disc.tau), bodies_.at(disc, time),
                             spin);
    }

    // Parts of answers for the time-stepped method, in which walls are at rest.

    bool is_periodic_along(Axis axis) const { return space_.is_periodic_along(axis); }
    RestingWalls<Real> resting_walls(Axis axis, const DiscState& disc) const {
        return {static_cast<Real>(along(axis, box_)), static_cast<Real>(bodies_.of(disc).radius),
                static_cast<Real>(band_)};
    }
    const typename Surroundings::Sides& sides() const { return sides_; }
    Body body_of(const DiscState& disc) const { return bodies_.at(disc, disc.tau); }

    // Obstacles.

    /// The first obstacle that the disc comes to.
    ObstacleContact first_obstacle(const DiscState& disc, const ContactTimes& times) const {
        return disc.has_departed()
                   ? ObstacleContact{}
                   : obstacles_->first_contact(disc, bodies_.of(disc).radius, times);
    }
    /// Reflects the disc from the obstacle that it comes to at `time`.
    Loss bounce_off(DiscState& disc, std::uint32_t body, double time, double since,
                    double* spin = nullptr) const {
        const Body its = bodies_.at(disc, time);
        advance(disc, time);
        Loss loss = obstacles_->rebound(disc, body, time, since, {spin, its.radius});
        loss.taken *= its.mass;
        loss.spared *= its.mass;
        disc.wall_collisions += 1;
        disc.has_collided = 1;
        return loss;
    }

private:
    Arithmetic arithmetic_;
    Box box_;
    double radius_, band_, tolerance_;
    InSpace space_;
    SpeciesTable species_; ///< owns what bodies look at
    OfBodies bodies_;
    Law law_;
    typename Surroundings::Sides sides_;
    typename Surroundings::Flight flight_;
    std::shared_ptr<const Obstacles> obstacles_; ///< null if there are none; copies share it
};

} // namespace carrom
