// SPDX-License-Identifier: BSD-3-Clause
// The parameters of a scene's effects: everything beyond free flight, elastic pairs and four
// elastic walls. law.hpp, bodies.hpp, boundaries.hpp, falling_frame.hpp, drag.hpp and
// fixed_bodies.hpp describe what the effects do.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <carrom/box.hpp>

#include "core/extent.hpp"
#include "core/image.hpp"
#include "core/side_columns.hpp"
#include "dynamics/external_field.hpp"
#include "dynamics/species.hpp"

namespace carrom {

/// The law of contact of two discs.
enum class ContactKind { elastic, none, restitution, rough };

/// Whether two entries of rows are equal. NaN stands for an entry that a row leaves out.
inline bool is_same_number(double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

/// A row of `effects.contact.pairs`: the coefficients for contacts of discs of two rows of
/// `discs.species`, counted from 1, in either order. NaN stands for the coefficient for all pairs.
struct ContactPair {
    double first = 1, second = 1;
    double restitution = 1, tangential_restitution = -1, friction = 0;

    friend bool operator==(const ContactPair& a, const ContactPair& b) {
        return a.first == b.first && a.second == b.second &&
               is_same_number(a.restitution, b.restitution) &&
               is_same_number(a.tangential_restitution, b.tangential_restitution) &&
               is_same_number(a.friction, b.friction);
    }
};
/// A row of `contacts` of a side or of the fixed bodies: the coefficients for discs of one row of
/// `discs.species`, counted from 1. NaN stands for the surface's coefficient for all discs.
struct SurfaceContact {
    double species = 1;
    double restitution = 1, tangential_restitution = -1, friction = 0;

    friend bool operator==(const SurfaceContact& a, const SurfaceContact& b) {
        return a.species == b.species && is_same_number(a.restitution, b.restitution) &&
               is_same_number(a.tangential_restitution, b.tangential_restitution) &&
               is_same_number(a.friction, b.friction);
    }
};
/// Discs of row `row` (from 0) of `discs.species` have ids from the previous `end` to `end` - 1.
struct SpeciesRow {
    DiscId end = 0;
    std::size_t row = 0;

    friend bool operator==(const SpeciesRow&, const SpeciesRow&) = default;
};

struct ContactEffect {
    ContactKind kind = ContactKind::elastic;
    double restitution = 1;  ///< share of the normal relative velocity that remains, 0 to 1
    double contact_time = 0; ///< a disc collides elastically for this time after a collision; if
                             ///< 0, a length is the limit instead (contact_guard.hpp); for the
                             ///< event-driven method only
    // For rough discs:
    /// e_t: where surfaces stick, a collision multiplies their relative velocity by -e_t; from -1
    /// (smooth) to 1
    double tangential_restitution = -1;
    double friction =
        std::numeric_limits<double>::infinity(); ///< coefficient of Coulomb's friction: the
                                                 ///< tangential impulse is at most this times the
                                                 ///< normal one
    double inertia = 0.5;             ///< moment of inertia over m r^2; 0.5 for a uniform disc
    std::vector<ContactPair> pairs{}; ///< pairs with coefficients of their own (pair_table.hpp)
    /// Ids of each row of `discs.species`, in ascending order; empty if a scene has no such key
    std::vector<SpeciesRow> rows{};

    bool is_on() const { return kind != ContactKind::elastic; }
    friend bool operator==(const ContactEffect&, const ContactEffect&) = default;
};

/// The kinds of sides. Each kind has a file in scene/boundaries.
enum class BoundaryKind { wall, thermal, moving, oscillating, open, periodic, sheared };

/// The words for kinds of sides in scenes, in the order of BoundaryKind.
inline constexpr auto boundary_words = std::to_array<std::string_view>(
    {"wall", "thermal", "moving", "oscillating", "open", "periodic", "sheared"});

/// How a wall or a fixed body acts along its surface (rubbing.hpp).
struct Surface {
    /// Tangential restitution of the contact, as between rough discs; -1 is a smooth surface
    double tangential_restitution = -1;
    double friction = std::numeric_limits<double>::infinity();
    double velocity = 0; ///< velocity of the surface: for sides (also thermal ones) along +x or +y;
                         ///< for fixed bodies counterclockwise; for arcs around their centres

    /// Whether the surface can change spins or tangential velocities.
    bool rubs() const { return tangential_restitution != -1 && friction != 0; }
    friend bool operator==(const Surface&, const Surface&) = default;
};

/// Discs that come in through an open side (scene/effects/inlets.cpp).
struct Inlet {
    double rate = 0;          ///< mean number of discs that come in per unit of time
    double temperature = 0;   ///< kT of the gas outside, in units of mass 1 times velocity squared
    std::int64_t species = 0; ///< a row of `discs.species`, counted from 1; 0 means any row

    bool is_on() const { return rate > 0; }
    friend bool operator==(const Inlet&, const Inlet&) = default;
};

struct Boundary {
    BoundaryKind kind = BoundaryKind::wall;
    double restitution = 1; ///< restitution of walls, also of moving and oscillating ones
    /// Temperature of thermal walls: kT, in units of mass 1 times velocity squared
    double temperature = 0;
    double speed = 0; ///< velocity of moving walls, along +x or +y
    // For oscillating walls (oscillation.hpp):
    double amplitude = 0;
    double period = 1;
    double phase = 0; ///< phase at the scene's start, in radians
    Surface surface{};
    Inlet inlet{}; ///< the inlet of an open side

    bool is_plain() const {
        return kind == BoundaryKind::wall && restitution == 1 && !surface.rubs();
    }
    /// Whether the box repeats itself beyond the side.
    bool is_periodic() const {
        return kind == BoundaryKind::periodic || kind == BoundaryKind::sheared;
    }
    friend bool operator==(const Boundary&, const Boundary&) = default;
};

/// Names in the order of Effects::boundaries: the low and the high side of x, then of y.
inline constexpr std::array<const char*, 4> boundary_names = {"left", "right", "bottom", "top"};

/// A uniform acceleration, such as gravity.
struct Acceleration {
    double x = 0, y = 0;
    // A part that changes in time, amplitude sin(2 pi t / period + phase), with t since the scene's
    // start (sway.hpp):
    double amplitude_x = 0, amplitude_y = 0;
    double period = 1;
    double phase_x = 0, phase_y = 0; ///< phases at the scene's start, in radians

    bool is_steady() const { return x != 0 || y != 0; }
    bool sways() const { return amplitude_x != 0 || amplitude_y != 0; }
    bool is_on() const { return is_steady() || sways(); }
    /// Upper bounds, for all times, of the magnitudes along x and y.
    double largest_x() const { return std::fabs(x) + std::fabs(amplitude_x); }
    double largest_y() const { return std::fabs(y) + std::fabs(amplitude_y); }
    double largest() const { return std::hypot(largest_x(), largest_y()); }
    friend bool operator==(const Acceleration&, const Acceleration&) = default;
};

/// A fixed disc. Like all fixed bodies in the box, it reflects discs (fixed_bodies.hpp).
struct FixedDisc {
    double x = 0, y = 0, radius = 0;

    friend bool operator==(const FixedDisc&, const FixedDisc&) = default;
};

struct Segment {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    friend bool operator==(const Segment&, const Segment&) = default;
};

/// A part of a circle, without thickness, from the angle `from` counterclockwise to the angle `to`,
/// in degrees from the direction of +x. The default is the whole circle.
struct Arc {
    double x = 0, y = 0, radius = 0;
    double from = 0, to = 360;

    bool is_whole() const { return to - from >= 360; }
    friend bool operator==(const Arc&, const Arc&) = default;
};

/// The coordinates of the corners, x0, y0, x1, y1, ...; the last corner is joined to the first.
using Polygon = std::vector<double>;

/// The shape of the region in which discs move (container.hpp).
enum class BoxShape { rectangle, round, stadium };

/// Coefficients of surfaces that depend on the species of the disc (surface_table.hpp).
struct SurfaceContacts {
    /// The sides in the order of Effects::boundaries, then the fixed bodies
    static constexpr std::size_t n_surfaces = 5, fixed_bodies = 4;

    std::array<std::vector<SurfaceContact>, n_surfaces> rows{};

    bool is_on() const {
        return std::any_of(rows.begin(), rows.end(), [](const auto& one) { return !one.empty(); });
    }
    friend bool operator==(const SurfaceContacts&, const SurfaceContacts&) = default;
};

struct FixedBodyList {
    std::vector<FixedDisc> discs;
    std::vector<Segment> segments;
    double restitution = 1;
    Surface surface{};
    std::vector<Arc> arcs{};
    std::vector<Polygon> polygons{};
    /// Boxes that are not rectangles have arcs and segments as walls
    BoxShape shape = BoxShape::rectangle;

    bool has_shape() const { return shape != BoxShape::rectangle; }
    bool are_any() const {
        return !discs.empty() || !segments.empty() || !arcs.empty() || !polygons.empty() ||
               has_shape();
    }
    bool is_on() const { return are_any(); }
    friend bool operator==(const FixedBodyList&, const FixedBodyList&) = default;
};

/// How a thermostat acts on discs at syncs (scene/effects/thermostat.cpp). Time unit: see Effects.
enum class ThermostatKind { none, kicks, andersen, langevin, rescale };

struct Thermostat {
    ThermostatKind kind = ThermostatKind::none;
    double strength = 0;    ///< strength xi^2 of the random kicks, a velocity squared per time
    double rate = 0;        ///< rate of new velocities (andersen) or friction rate (langevin)
    double temperature = 0; ///< kT, in units of mass 1 times velocity squared
    std::uint64_t seed = 3210;

    bool is_on() const { return kind != ThermostatKind::none; }
    /// Whether the thermostat is a bath, with which discs exchange momentum as well as energy.
    bool is_bath() const {
        return kind == ThermostatKind::andersen || kind == ThermostatKind::langevin;
    }
    bool has_temperature() const { return is_on() && kind != ThermostatKind::kicks; }
    friend bool operator==(const Thermostat&, const Thermostat&) = default;
};

/// Discs that propel themselves (scene/effects/activity.cpp). Time unit: see Effects.
struct Activity {
    double speed = 0; ///< speed of a free disc whose direction does not change
    double force = 0; ///< used instead of `speed`: the same force on all discs, whatever their mass
    double rotational_diffusion = 0; ///< mean squared change of the angle per time, divided by 2
    double tumble_rate = 0;          ///< rate at which a disc takes a new random direction
    std::uint64_t seed = 3210;

    bool is_on() const { return speed != 0 || force != 0; }
    friend bool operator==(const Activity&, const Activity&) = default;
};

/// Whether a barostat keeps the ratio of the box's sides, or changes each side separately.
enum class BarostatAxes { together, each };

/// Changes of the volume at syncs (scene/effects/barostat.cpp).
struct Barostat {
    double pressure = 0; ///< P times the mean squared diameter over kT; 0 means no barostat
    BarostatAxes axes = BarostatAxes::together;
    std::uint64_t seed = 4321;

    bool is_on() const { return pressure != 0; }
    /// The shortest and the longest length that a side can reach, relative to the scene's box.
    double shortest_side() const { return is_on() && axes == BarostatAxes::each ? 0.5 : 1; }
    double longest_side() const { return 1 / shortest_side(); }
    friend bool operator==(const Barostat&, const Barostat&) = default;
};

/// Discs that exchange their radii (scene/effects/swap.cpp).
struct Swaps {
    std::int64_t rounds = 0;     ///< rounds of proposals at each sync
    std::int64_t until_step = 0; ///< the step at which swaps end; 0 means the end of the run
    std::uint64_t seed = 3210;

    bool is_on() const { return rounds != 0; }
    friend bool operator==(const Swaps&, const Swaps&) = default;
};

/// Values of the keys of effects that act only at syncs. The source file of such an effect declares
/// its keys (`own_key` in scene/key_members.hpp) and reads their values by name; no other code uses
/// them.
class OwnNumbers {
public:
    /// The value of the key, or 0 if the scene does not set it.
    double of(std::string_view key) const {
        const auto found = numbers_.find(key);
        return found == numbers_.end() ? 0 : found->second;
    }
    void set(std::string_view key, double number) { numbers_[std::string(key)] = number; }
    bool is_on() const {
        return std::any_of(numbers_.begin(), numbers_.end(),
                           [](const auto& one) { return one.second != 0; });
    }
    friend bool operator==(const OwnNumbers&, const OwnNumbers&) = default;

private:
    std::map<std::string, double, std::less<>> numbers_;
};

// Whether a feature of Effects is on.
inline bool is_feature_on(double rate) { return rate != 0; }
inline bool is_feature_on(const std::vector<Species>& species) { return !species.empty(); }
inline bool is_feature_on(const std::array<Boundary, 4>& sides) {
    return !std::all_of(sides.begin(), sides.end(), [](const Boundary& s) { return s.is_plain(); });
}
template <class Feature> bool is_feature_on(const Feature& feature) { return feature.is_on(); }

/// Times are in steps in a scene, and in micro-steps in a dynamics (per_micro_step in
/// scene/key.hpp).
struct Effects {
    ContactEffect contact;
    std::array<Boundary, 4> boundaries;
    Acceleration gravity;
    double drag = 0; ///< the rate at which discs lose their velocity, dv/dt = -drag v
    std::uint64_t thermal_seed = 3210;
    std::uint64_t inlet_seed = 3210;
    FixedBodyList fixed_bodies{};
    SurfaceContacts surface_contacts{};
    std::vector<Species>
        species{};     ///< in order of id; empty if all discs have the same radius and mass 1
    double growth = 0; ///< growth rate of radii, relative to the radii at the start
    double shear = 0;  ///< shear rate: the flow's d(vx)/dy between sheared sides
    /// Pairs that approach more slowly than this have lasting contacts from sync to sync
    /// (contact_impulses.hpp); 0 means none.
    double lasting_speed = 0;
    Thermostat thermostat{};
    Activity activity{};
    Swaps swap{};
    Barostat barostat{};
    OwnNumbers own{};
    ExternalField field{};

    /// All features. Seeds are left out, because a seed alone has no effect.
    auto features() const {
        return std::tie(contact, boundaries, gravity, drag, fixed_bodies, surface_contacts, species,
                        growth, shear, lasting_speed, thermostat, activity, swap, barostat, own,
                        field);
    }
    /// The uniform acceleration of discs in free flight, without drag.
    Acceleration acceleration() const { return gravity; }
    /// Whether velocities change only in collisions and at syncs.
    bool are_flights_free() const { return !acceleration().is_on() && drag == 0; }
    bool have_spins() const { return contact.kind == ContactKind::rough; }
    /// Whether all sides are elastic walls at rest that do not rub, for discs of all species.
    bool have_plain_boundaries() const;
    bool have_open_boundaries() const;
    /// The reader of scenes ensures that two opposite sides are either both periodic or neither is.
    bool is_periodic_x() const { return boundaries[0].is_periodic(); }
    bool is_periodic_y() const { return boundaries[2].is_periodic(); }
    bool are_sheared() const { return boundaries[2].kind == BoundaryKind::sheared; }
    bool are_periodic() const { return is_periodic_x() || is_periodic_y(); }
    /// The periods at the scene's start; see Periods::begin_interval.
    Periods periods(const Box& box) const {
        return {is_periodic_x() ? box.x : 0, is_periodic_y() ? box.y : 0, 0,
                are_sheared() ? shear * box.y : 0};
    }
    /// The mean velocity along x at the height `y` of a sheared box; 0 in other boxes.
    double flow_at(double y, const Box& box) const {
        return are_sheared() ? shear * (y - box.y / 2) : 0;
    }
    /// The factor by which radii have grown from the scene's start to `time`.
    double size_at(double time) const { return 1 + growth * time; }
    /// Adapts the rate to a new start, at which radii have already grown by the factor `size`.
    void begin_at(double size) { growth /= size; }
    bool are_any() const {
        return std::apply([](const auto&... all) { return (is_feature_on(all) || ...); },
                          features());
    }
    friend bool operator==(const Effects&, const Effects&) = default;
};

/// The side columns (core/side_columns.hpp) that a run with these effects has.
SideColumnSet side_columns_of(const Effects& effects);

/// The part of a summary line that describes the species; empty without species. `summary_of`
/// (scene/effects/effect.hpp) writes the whole line.
std::string description(const std::vector<Species>& species);

/// Positions of the walls at `time` since the scene's start; `box` is the box at the start.
Extent extent_at(const Effects& effects, const Box& box, double time);
/// The mean positions of the walls, each moved inwards by `amplitudes_inwards` amplitudes.
Extent extent_of_lines(const Effects& effects, const Box& box, double time,
                       double amplitudes_inwards = 0);

/// The largest speed of oscillating walls; 0 if there are none.
double largest_wall_speed(const Effects& effects);
/// The largest acceleration of oscillating walls; 0 if there are none.
double largest_wall_pull(const Effects& effects);

} // namespace carrom
