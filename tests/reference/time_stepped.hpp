// SPDX-License-Identifier: BSD-3-Clause
// A plain implementation of the time-stepped method (docs/understanding/method.md, sections 1 to
// 4), with which the engine is compared bit by bit.
//
// Every micro-step searches all pairs, sorts all candidates by the total order and walks through
// them. It has no cells, windows, filters or strips, and none of the engine's arithmetic: the
// formulas are written a second time from the page. Price: N^2/2 predicates a micro-step, some 5 ns
// each.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <carrom/box.hpp>

#include "core/disc_state.hpp"
#include "dynamics/effects.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom::reference {

/// An image of a disc, displaced by this many boxes.
struct Copy {
    int x = 0, y = 0;

    friend bool operator==(const Copy&, const Copy&) = default;
};

/// The repetition of the box. Under shear: the shift of the row above along x at the last sync, and
/// its speed per micro-step.
struct Tiles {
    Box box{};
    double slid = 0, speed = 0;

    double x_to(Copy copy, double time) const {
        return copy.x * box.x + copy.y * (slid + speed * time);
    }
    double y_to(Copy copy) const { return copy.y * box.y; }
    double vx_of(Copy copy) const { return copy.y * speed; }
};

/// The box and the clock of a run. Inputs give velocities per step; `micro_steps` divides them.
struct Setting {
    double box_size = 0; ///< edge along x
    double radius = 0;
    std::int64_t micro_steps = 1;
    std::int64_t sync_every = 64;
    Effects effects{};                 ///< times in steps
    double box_height = 0;             ///< edge along y; 0 for a square
    std::vector<double> first_spins{}; ///< spins of rough discs by id, per step; empty if all are 0
    /// Random numbers for a disc that leaves a thermal wall: its velocity away from the wall and
    /// along it, in the unit of the side's temperature.
    std::function<std::array<double, 2>(const Boundary& side, DiscId id,
                                        std::uint64_t wall_collisions, std::size_t number)>
        thermal_draw{};

    /// With drag: the time on its clock after this many micro-steps since a sync.
    std::function<double(double micro_steps)> drag_clock{};
    /// Gravity under drag, or a wall that moves: the distance of a falling body from rest, divided
    /// by its acceleration, and the time at which it meets a wall, all on the clock and per
    /// micro-step. The caller provides these functions, which other tests compare with
    /// the body's path.
    std::function<double(double clock)> dragged_fall{};
    std::function<double(double distance, double velocity, double pull)> dragged_fall_delay{};
    /// For obstacles under gravity: see FixedBodies::meeting_time. The caller provides it, and
    /// other tests compare it with the body's path.
    std::function<double(double dx, double dy, double wx, double wy, double gx, double gy,
                         double reach)>
        falling_contact{};
    Box box() const { return {box_size, box_height == 0 ? box_size : box_height}; }
    double longest() const { return box().x > box().y ? box().x : box().y; }
    /// The length of the box along the axis at whose end the side is.
    double edge(std::size_t side) const { return side < 2 ? box().x : box().y; }
    /// An oscillating wall: its distance from its line, its velocity, and the acceleration that
    /// presses discs against it; and the time at which a disc meets it, from its distance and rate
    /// relative to the line and its rate relative to the wall. Times count from the sync at a
    /// micro-step. The caller provides these functions, which other tests compare with a search.
    std::function<std::array<double, 3>(std::size_t side, std::int64_t sync, double time)>
        oscillation{};
    std::function<double(std::size_t side, std::int64_t sync, double distance, double rate,
                         double from_wall, double time)>
        oscillating_delay{};
    /// The tiles from the sync at this micro-step on.
    Tiles tiles(std::int64_t sync) const;
    double clock_at(std::int64_t count) const {
        const auto time = static_cast<double>(count);
        return drag_clock ? drag_clock(time) : time;
    }
    /// The factor from velocities on the clock to velocities in the box.
    double slowing_at(double clock) const {
        return 1 - effects.drag / static_cast<double>(micro_steps) * clock;
    }

    /// `thermal_draw` in micro-steps for a disc at the wall `number`.
    std::array<double, 2> leaving(const DiscState& disc, std::size_t number) const;
    double radius_of(DiscId id) const { return species_of(id).radius; }
    double mass_of(DiscId id) const { return species_of(id).mass; }
    Species species_of(DiscId id) const;
    bool are_rough() const { return effects.contact.kind == ContactKind::rough; }
    bool discs_meet() const { return effects.contact.kind != ContactKind::none; }
    double restitution() const {
        return effects.contact.kind == ContactKind::restitution ? effects.contact.restitution : 1;
    }
    /// The contact time, or 0 if contacts are a length: a millionth of the sum of both radii, and a
    /// ten-thousandth of the radius at walls.
    double contact_time() const {
        return effects.contact.contact_time * static_cast<double>(micro_steps);
    }
    /// Whether discs or a wall that approach at `speed` belong to a contact that began `since` ago.
    bool is_in_contact(double since, double speed, double radii, double share) const {
        return contact_time() > 0 ? since < contact_time() : since * speed < share * radii;
    }
    /// The smallest speed at which a disc of this radius leaves a wall to which it is pulled.
    double least_departure(double pull, double disc_radius) const {
        return contact_time() > 0 ? 0.5 * pull * contact_time()
                                  : std::sqrt(0.5 * 1e-4 * disc_radius * pull);
    }
};

class FixedBodies;
struct BodyMeeting;

struct Counters {
    std::uint64_t candidates = 0;
    std::uint64_t rejected_candidates = 0;
    std::uint64_t wall_collisions = 0;
    std::uint64_t pair_collisions = 0; ///< counts pairs, not discs

    friend bool operator==(const Counters&, const Counters&) = default;
};

/// A collision that happens: disc p with a wall, or the pair p < q. In a micro-step they are sorted
/// by (t, p, wall before pair, q).
struct Collision {
    static constexpr DiscId wall = ~DiscId{0};

    std::int64_t micro_step = 0; ///< n for the time from n to n+1 since the start of the run
    double t = 0;                ///< in-step time, 0 to 1
    DiscId p = 0;
    DiscId q = wall;
    Copy copy{}; ///< the image of q in a box with periodic sides

    friend bool operator==(const Collision&, const Collision&) = default;
};

/// A pair's contact: delay after `base`, the later of the two local times; negative if there is
/// none.
struct Contact {
    double base = 0;
    double delay = -1;
};

/// The predicate of section 4, for p and an image of q (in a box without periodic sides, q itself).
/// `tolerance` is the deepest overlap that still collides; infinity in the event-driven method.
Contact contact(const DiscState& p, const DiscState& q, double sigma, double tolerance,
                Copy copy = {}, const Tiles& tiles = {});

/// The copies of q that p may approach until `end`, if both fly on from their states. All others
/// stay farther away than sigma.
std::vector<Copy> copies_near(const Setting& setting, const DiscState& p, const DiscState& q,
                              double begin, double end, const Tiles& tiles);

/// Brings a state into the box at a sync if sides are periodic, with one rounding. `tiles` are
/// those before the sync.
void bring_inside(const Setting& setting, DiscState& disc, const Tiles& tiles);

/// Whether a disc has left the box. It is then at rest where it left, with a time that no other
/// disc has.
bool has_left(const DiscState& disc);
void set_left(const Setting& setting, DiscState& disc, std::size_t side);

/// The two states' positions at `time`, and the impulse of a pair; p has the lower id.
void advance(DiscState& disc, double time);
void exchange_momentum(const Setting& setting, DiscState& p, DiscState& q, double restitution,
                       Copy copy = {}, const Tiles& tiles = {});
/// The collision of rough discs, by the formulas of the page; a guarded pair (`is_touched`) is
/// elastic and smooth.
void collide_rough(const Setting& setting, DiscState& p, DiscState& q, double& p_spin,
                   double& q_spin, bool is_touched, Copy copy = {}, const Tiles& tiles = {});

/// Numbers the discs 0 .. N-1 as given (ids must be a permutation of these) and divides velocities
/// by `micro_steps`.
std::vector<DiscState> stored_states(const Setting& setting, std::span<const InputDisc> discs);
/// Spins by id, per micro-step; empty unless discs are rough.
std::vector<double> stored_spins(const Setting& setting, std::size_t n_discs);

class TimeSteppedReference {
public:
    TimeSteppedReference(const Setting& setting, std::span<const InputDisc> discs);

    void run_micro_steps(std::int64_t count);
    void run_steps(std::int64_t count) { run_micro_steps(count * setting_.micro_steps); }

    /// Discs in the order of ids; velocities per micro-step, times on `clock()`.
    std::span<const DiscState> discs() const { return discs_; }
    /// Spins by id, angles per micro-step; empty unless discs are rough.
    std::span<const double> spins() const { return spins_; }
    /// Micro-steps since the last sync.
    double clock() const { return static_cast<double>(micro_step_ % setting_.sync_every); }
    const Counters& counters() const { return counters_; }
    const std::vector<Collision>& log() const { return log_; }

private:
    std::int64_t last_sync() const {
        return micro_step_ / setting_.sync_every * setting_.sync_every;
    }
    void run_micro_step();
    void find_candidates(double m);
    void keep(const Collision& candidate, double m);
    void synchronize();

    double wall_time(const DiscState& disc, double m) const;
    double axes_time(const DiscState& disc, double m) const;
    double axis_time(DiscId id, double x, double v, double tau, double m,
                     std::size_t low_side) const;
    void bounce(DiscState& disc, double m, double t) const;
    void bounce_off(DiscState& disc, double m, double t) const;
    void stop_at_wall(DiscState& disc, double m, double t, const BodyMeeting& left) const;
    double stop_time(DiscId id, double x, double v, double t, std::size_t low_side) const;
    bool leads_out(double v, std::size_t low_side) const;

    Setting setting_;
    std::shared_ptr<const FixedBodies> species_;
    double low(DiscId id) const { return setting_.radius_of(id); }
    double high(DiscId id, std::size_t side) const {
        return setting_.edge(side) - setting_.radius_of(id);
    }

    double band_, tolerance_;
    std::vector<DiscState> discs_;
    std::vector<double> spins_;
    std::vector<Collision> candidates_;
    std::int64_t micro_step_ = 0;
    Counters counters_;
    std::vector<Collision> log_;
};

} // namespace carrom::reference
