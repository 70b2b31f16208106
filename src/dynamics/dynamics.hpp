// SPDX-License-Identifier: BSD-3-Clause
// What an author of an effect must answer: the questions that engines ask a dynamics.
//
// Kernels take the dynamics as a template argument, chosen once at start (dynamics_of_scene.hpp).
// Lengths are the scene's. Times are micro-steps since the last sync, on the dynamics' own clock.
// Places and velocities are those of its frame. In the time-stepped method t is a time within
// micro-step m, 0 to 1. Answers depend on the stored states alone, so all ranks get the same bits.
#pragma once

#include <concepts>
#include <cstdint>

#include "core/axis.hpp"
#include "core/flight_integral.hpp"
#include "core/frame.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/loss.hpp"
#include "dynamics/obstacles.hpp"
#include "dynamics/pair_contact.hpp"

namespace carrom {

template <class D>
concept Dynamics = std::copyable<D> && requires(D changing, const D d, DiscState& p, DiscState& q,
                                                const DiscState& disc, std::int64_t n, double time,
                                                double m, double t, double* spin, Axis axis) {
    // What can happen in a scene. Kernels compile no code for what cannot.
    { D::is_periodic } -> std::convertible_to<bool>;        // discs have images
    { D::has_moving_images } -> std::convertible_to<bool>;  // images move with their row
    { D::has_species } -> std::convertible_to<bool>;        // radii and masses differ
    { D::has_spin } -> std::convertible_to<bool>;           // collisions use and change spins
    { D::has_mirror_walls } -> std::convertible_to<bool>;   // walls only reverse a velocity
    { D::may_have_obstacles } -> std::convertible_to<bool>; // fixed bodies stand in the box
    { D::may_lose_discs } -> std::convertible_to<bool>;     // discs leave through open sides
    { D::has_elastic_pairs } -> std::convertible_to<bool>;  // they keep the kinetic energy
    { D::is_for_study } -> std::convertible_to<bool>;       // states are rounded, contacts missed
    { d.has_pairs() } -> std::same_as<bool>;                // discs collide with each other
    { d.has_walls() } -> std::same_as<bool>;                // discs can meet walls or obstacles
    { d.has_obstacles() } -> std::same_as<bool>;
    { d.has_open_sides() } -> std::same_as<bool>;
    { d.parts_overlaps() } -> std::same_as<bool>; // overlapping discs collide if they approach
    // Thousands of collisions of a disc within this many micro-steps are an endless cascade.
    { D::cascade_interval } -> std::convertible_to<double>;

    // Sizes. The radius is the largest one.
    { d.box() } -> std::same_as<const Box&>;
    { d.radius() } -> std::same_as<double>;
    { d.diameter() } -> std::same_as<double>;
    { d.tolerance() } -> std::same_as<double>;       // rounding makes no deeper overlap than this
    { d.slack() } -> std::convertible_to<double>;    // largest gap between discs in a contact
    { d.search_diameter() } -> std::same_as<double>; // largest distance of centres in a contact
    // These lengths are for radii that have not grown. Radii have grown by this factor:
    { d.growth_at(time) } -> std::convertible_to<double>;

    // Speeds that searches allow for: the disc's own, and that of its image in the box at a time.
    { d.squared_speed(disc) } -> std::same_as<double>;
    { d.squared_speed_at(disc, time) } -> std::same_as<double>;

    // Clock and frame, in which discs fly straight.
    changing.begin_interval(n);                   // times now count from micro-step n
    { d.clock_at(time) } -> std::same_as<double>; // at micro-steps since the sync
    { d.micro_steps_at(time) } -> std::same_as<double>;
    { d.frame_at(time) } -> std::same_as<Frame>;
    { d.has_own_frame() } -> std::same_as<bool>;
    { d.extent_at(time) } -> std::same_as<Extent>;     // where the walls are
    { d.jump_at(axis, time) } -> std::same_as<double>; // how far the frame moves at a sync
    { d.flight_integral_at(time) } -> std::same_as<FlightIntegral>; // see StressSums
    { d.pair_weight_at(time) } -> std::convertible_to<double>;
    { d.speed_gained_at(time) } -> std::same_as<double>; // bound on the frame's gain
    d.restart_frame(p, time); // the state in the frame of the next interval
    D::advance(p, time);      // free flight

    // The time-stepped method: the candidate of a pair, and the one of a disc and a fixed body.
    { d.contact(disc, disc).exists() } -> std::same_as<bool>;
    { d.wall_time(disc, m) } -> std::same_as<double>; // t of the first bounce in m, or never
    d.bounce(p, m, t, spin); // carries out the bounce at wall_time; spin is null without rotation
    { d.met_walls(disc, m, t) }; // the walls that it bounces off

    // The event-driven method: times of the next events.
    { d.event_contact(disc, disc).exists() } -> std::same_as<bool>;
    { d.x_wall_time(disc) } -> std::same_as<double>;
    { d.y_wall_time(disc) } -> std::same_as<double>;
    { d.bounce_x_at(p, time, spin) } -> std::same_as<Loss>;
    { d.bounce_y_at(p, time, spin) } -> std::same_as<Loss>;
    // False only if neither wall time is up to `time`.
    { d.may_meet_wall(disc, time) } -> std::same_as<bool>;
    // A disc inside at some time in between, and within these walls at the end, has met none.
    { d.walls_between(time, time) } -> std::same_as<Extent>;

    // Answers that only some dynamics give. `p` has the lower id.
    requires D::has_spin || requires {
        d.collide(p, q, m, t); // time-stepped: the contact, and stops at walls
        { d.collide_at(p, q, time) } -> std::same_as<Loss>;
    };
    requires !D::has_spin || requires(double& p_spin, double& q_spin) {
        d.collide(p, q, m, t, p_spin, q_spin);
        { d.collide_at(p, q, time, p_spin, q_spin) } -> std::same_as<Loss>;
    };
    requires !D::has_species || requires { d.species_table().of(DiscId{}); };
    requires !D::may_have_obstacles || requires(const ContactTimes& times, std::uint32_t body) {
        { d.first_obstacle(disc, times) } -> std::same_as<ObstacleContact>;
        { d.bounce_off_at(p, body, time, spin) } -> std::same_as<Loss>;
    };
    requires !D::is_periodic || requires {
        { d.periods() } -> std::convertible_to<Periods>;
        d.wrap(p); // into the box, after a sync
    };
    requires !D::is_for_study || requires { D::round(p); };
};

} // namespace carrom
