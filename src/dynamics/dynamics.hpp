// SPDX-License-Identifier: BSD-3-Clause
// The dynamics of discs: a space, bodies and a law, and the walls and fixed bodies that discs meet.
//
//        space (space.hpp)         which image of a disc another disc meets, and where it is
//        bodies (bodies.hpp)       radius, mass, speed of the surface
//        law (law.hpp)             how a collision changes velocities and spins
//      + arithmetic                precision, and formula of contacts (arithmetic.hpp)
//        sides, fixed bodies,
//        flight                    walls, fixed bodies, and the frame of flights (surroundings.hpp)
//
// Each part is a class with its own header; the headers of spaces and bodies also define a concept.
// The code that uses the first four parts is in motion.hpp; the code for walls and fixed bodies is
// here. Kernels take a dynamics as a template argument. Choices that would otherwise be made for
// each pair are template parameters. All others are made at run time, so that few combinations are
// compiled (all_dynamics.hpp).
//
// Lengths are in the scene's unit. Times are micro-steps since the last sync, on the dynamics' own
// clock. Positions and velocities are in the dynamics' own frame. Results depend only on the stored
// states, so all ranks get the same bits. If the parameters of an effect switch it off, the bits
// are those of plain dynamics.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "core/axis.hpp"
#include "core/flight_integral.hpp"
#include "core/frame.hpp"
#include "dynamics/fixed_bodies.hpp"
#include "dynamics/motion.hpp"
#include "dynamics/never.hpp"
#include "dynamics/surroundings.hpp"

namespace carrom {

template <Space InSpace, Bodies OfBodies, class Surroundings = SurroundingsOfEffects>
class Dynamics : public Motion<InSpace, OfBodies, Surroundings> {
    using Base = Motion<InSpace, OfBodies, Surroundings>;
    using Base::arithmetic_, Base::box_, Base::radius_, Base::band_, Base::tolerance_, Base::space_;
    using Base::bodies_;

public:
    using Base::advance, Base::have_effects, Base::is_periodic, Base::has_moving_images;
    using Base::may_lose_discs;
    using typename Base::Arithmetic, typename Base::Real;

    static constexpr bool has_mirror_walls = !have_effects, // walls only reverse a velocity
        may_have_fixed_bodies = have_effects;
    /// If discs collide thousands of times within this many micro-steps, the run ends as a
    /// collision cascade.
    static constexpr double cascade_interval = std::max(OfBodies::cascade_interval,
                                                        Arithmetic::cascade_interval);
    static constexpr double never = carrom::never;

    /// `effects` have times in micro-steps; `radius` is the largest radius of a disc.
    Dynamics(const Box& box, double radius, const Effects& effects = {},
             ContactFormula formula = ContactFormula::stable)
        : Dynamics(box, radius, effects, formula,
                   SpeciesTable(effects.species, Arithmetic::rounded(radius), effects.swap.is_on()),
                   PairTable(effects.contact)) {}

    /// The part of the dynamics that kernels on a GPU use.
    const Base& motion() const { return *this; }

    /// Starts a sync interval: from now on times are relative to micro-step `n` of the scene.
    void begin_interval(std::int64_t n) {
        space_.begin_interval(n);
        bodies_.begin_interval(n);
        sides_.begin_interval(n);
        flight_.begin_interval(static_cast<double>(n));
    }

    /// Sets all radii to the scene's radii times `size`. Only for bodies that can grow, in a scene
    /// with a growth rate of 0.
    void resize(double size) {
        if constexpr (OfBodies::grow) bodies_.resize(size);
    }

    /// Changes the lengths of the box's sides. Only for bodies that can grow, in a scene whose
    /// sides are all periodic.
    void reshape([[maybe_unused]] const Box& box) {
        if constexpr (OfBodies::grow) Base::reshape(box);
    }

    // Properties of the scene.

    /// Whether discs can meet walls or fixed bodies.
    bool has_walls() const { return space_.has_sides() || has_fixed_bodies(); }
    bool has_fixed_bodies() const { return may_have_fixed_bodies && fixed_bodies_ != nullptr; }
    bool has_open_sides() const { return may_lose_discs && sides_.are_any_open(); }
    const SpeciesTable& species_table() const { return species_; }

    // The clock and the frame in which discs fly straight. `time` is always on this clock.

    double clock_at(double micro_steps) const { return flight_.clock_at(micro_steps); }
    double micro_steps_at(double clock) const { return flight_.micro_steps_at(clock); }
    Frame frame_at(double time) const { return flight_.at(time); }
    bool has_own_frame() const { return flight_.is_on(); }
    double slowing_at(double time) const { return flight_.slowing_at(time); }
    /// Converts a state at `time` to the frame of the next interval.
    void restart_frame(DiscState& disc, double time) const { flight_.restart(disc, time); }
    double jump_at(Axis axis, double time) const { return flight_.jump_at(axis, time); }
    double speed_gained_at(double time) const { return flight_.speed_gained_at(time); }
    /// See engine/stress_sums.hpp. Under shear, kinetic stress is relative to the flow and changes
    /// during flights. It is sampled at syncs instead, and this integral is 0.
    FlightIntegral flight_integral_at(double time) const {
        if constexpr (has_moving_images) return {};
        return flight_.flight_integral_at(time);
    }
    double pair_weight_at(double time) const {
        return has_moving_images ? 0 : flight_.pair_weight_at(time);
    }

    // Sides. Here and below, `spin` is null if discs do not turn.

    Extent extent_at(double time) const { return sides_.extent_at(time); } ///< walls' positions
    /// A disc that was inside the walls at some time in [begin, end] has met no wall since then if
    /// its straight flight, as if there were no walls, ends within these bounds.
    Extent walls_between(double begin, double end) const {
        return sides_.walls_between(begin, end);
    }
    /// The time at which the disc meets the low or the high side of this axis, or `never`.
    double wall_time(const DiscState& disc, Axis axis) const {
        return sides_.wall_time(disc, axis, bodies_.at(disc, disc.tau));
    }
    /// False means that the disc meets no wall before `time`; true means that it may meet one.
    bool may_meet_wall(const DiscState& disc, double time) const {
        const Body body = bodies_.at(disc, disc.tau);
        // The product is the distance that a fast disc flies within the rounding error of a time.
        const double fastest = std::max(std::fabs(disc.vx), std::fabs(disc.vy)) +
                               (speed_gained_at(time) + body.outwards);
        const double margin = (tolerance_ + arithmetic_.place_rounding()) +
                              Arithmetic::time_rounding * time * fastest;
        return sides_.may_meet(disc, time, margin, body);
    }
    /// Carries out the collision at `time` = wall_time(disc, axis).
    Loss bounce(DiscState& disc, Axis axis, double time, double* spin = nullptr) const {
        return sides_.bounce(disc, axis, time, bodies_.at(disc, disc.tau), bodies_.at(disc, time),
                             spin);
    }

    const typename Surroundings::Sides& sides() const { return sides_; }

    // Fixed bodies.

    /// The first fixed body that the disc meets within these times.
    BodyContact first_fixed_body(const DiscState& disc, const ContactTimes& times) const {
        return disc.has_departed() ? BodyContact{}
                                   : fixed_bodies_->first_contact(disc, size_of(disc), times);
    }
    /// True if the disc overlaps no fixed body in the states `from` and `to`, and meets none on its
    /// flight from the start of this interval to `time`.
    bool is_way_free(const DiscState& from, const DiscState& to, double time) const {
        if (!has_fixed_bodies()) return true;
        const DiscSize size = size_of(from);
        const auto is_clear = [&](const DiscState& disc) {
            return !fixed_bodies_->do_overlap(disc.x, disc.y, size.radius);
        };
        return is_clear(from) && is_clear(to) &&
               !fixed_bodies_->first_contact(from, size, {0, time}).exists();
    }
    /// Where a disc touches the fixed body that it meets at `time`.
    BodyTouch touch(const DiscState& disc, std::uint32_t body, double time) const {
        DiscState there = disc;
        advance(there, time);
        return fixed_bodies_->touch(there, body, time, bodies_.at(there, time).radius);
    }
    /// Reflects the disc from the fixed body that it meets at `time`.
    Loss bounce_off(DiscState& disc, std::uint32_t body, double time, double since,
                    double* spin = nullptr) const {
        const Body its = bodies_.at(disc, time);
        advance(disc, time);
        Loss loss = fixed_bodies_->rebound(disc, body, time, since, its.outwards,
                                           {spin, its.radius});
        loss.taken *= its.mass;
        loss.spared *= its.mass;
        disc.wall_collisions += 1;
        disc.has_collided = 1;
        return loss;
    }

private:
    DiscSize size_of(const DiscState& disc) const {
        const Body body = bodies_.at(disc, disc.tau);
        return {body.radius, body.outwards};
    }

    Dynamics(const Box& box, double radius, const Effects& effects, ContactFormula formula,
             SpeciesTable species, PairTable pairs)
        : Base(box, radius, effects, formula, species.view(), pairs.view()),
          species_(std::move(species)), pairs_(std::move(pairs)), sides_(box_, radius_, effects),
          flight_(effects) {
        if (may_have_fixed_bodies && effects.fixed_bodies.are_any())
            fixed_bodies_ = std::make_shared<const FixedBodies>(box_, radius_, effects);
    }

    SpeciesTable species_; ///< owns the table that bodies read
    PairTable pairs_;      ///< owns the table that the law reads
    typename Surroundings::Sides sides_;
    typename Surroundings::Flight flight_;
    std::shared_ptr<const FixedBodies> fixed_bodies_; ///< null if there are none; shared by copies
};

} // namespace carrom
