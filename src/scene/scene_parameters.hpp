// SPDX-License-Identifier: BSD-3-Clause
// One checked description of a run. Every reader ends in `SceneParameters`; after that nothing
// reads the input's text again.
//
// Velocities and times are the scene's (per step). The engine divides by `micro_steps`
// when it takes the discs.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <carrom/box.hpp>

#include "core/disc_state.hpp"
#include "dynamics/effects.hpp"
#include "scene/size_distribution.hpp"

namespace carrom {

enum class Method { time_stepped, event_driven };
/// The precision of stored states and of computation.
enum class Precision { double_, single };
/// How contacts are found: by the predicate, or by the course program's formula.
enum class Arithmetic { stable, naive };
enum class Generator { random, lattice, triangular, compressed, legacy, file };
enum class VelocityKind {
    maxwell,
    uniform,
    reversed ///< given velocities, turned round
};

/// The lines on standard output: none, steps 0 and S, or every step (the course
/// program's `perf` and `print`).
enum class TextOutput { none, first_and_last, every_step };

/// A disc as inputs give it, with its velocity per step.
struct InputDisc {
    DiscId id = 0;
    double x = 0, y = 0, vx = 0, vy = 0;

    friend bool operator==(const InputDisc&, const InputDisc&) = default;
};

/// Consecutive ids, up to `end`, of discs with the same number at the start; per step
/// if it is a rate.
struct NumberRun {
    DiscId end = 0;
    double number = 0;

    friend bool operator==(const NumberRun&, const NumberRun&) = default;
};
/// In the order of ids; a column in which all discs begin with 0 has none.
using FirstNumbers = BySideColumn<std::vector<NumberRun>>;

/// The numbers that a line of `discs_file` may have. The columns beside the states come last.
enum class DiscColumn : std::size_t { id, x, y, vx, vy, radius, mass, first_side };

constexpr DiscColumn disc_column_of(SideColumn column) {
    return static_cast<DiscColumn>(static_cast<std::size_t>(DiscColumn::first_side) +
                                   static_cast<std::size_t>(column));
}
/// For a column that is neither radius nor mass.
constexpr SideColumn side_column_of(DiscColumn column) {
    return static_cast<SideColumn>(static_cast<std::size_t>(column) -
                                   static_cast<std::size_t>(DiscColumn::first_side));
}

/// The point of the box, from its lower left corner, that has the coordinates (0, 0) in what users
/// write and read. All that computes counts from the corner (scene/places.hpp).
struct Origin {
    double x = 0, y = 0;
    bool is_centre = false; ///< follows the box; x and y are set once that is known

    bool is_any() const { return x != 0 || y != 0; }
    friend bool operator==(const Origin& a, const Origin& b) { return a.x == b.x && a.y == b.y; }
};

/// Discs generated inside this rectangle get this velocity added: a jet, a shear, a piston-like
/// slab.
struct Stream {
    double x_low = 0, y_low = 0, x_high = 0, y_high = 0;
    double vx = 0, vy = 0;
};

/// A rectangle in which discs begin at random, whole.
struct StartRegion {
    double x_low = 0, y_low = 0, x_high = 0, y_high = 0;

    friend bool operator==(const StartRegion&, const StartRegion&) = default;
};
/// Consecutive ids, up to `end`, of discs of one region, or of none of their own.
struct RegionRun {
    DiscId end = 0;
    std::optional<StartRegion> region;

    friend bool operator==(const RegionRun&, const RegionRun&) = default;
};

/// Discs of one species that begin alike, with consecutive ids.
struct DiscGroup {
    std::uint64_t count = 0;
    std::size_t species = 0; ///< a row of `discs.species`, counted from 0
    std::optional<StartRegion> region;
    std::optional<double> temperature, speed; ///< kT, or root mean square; else those of all discs
    Generator generator = Generator::random;
    bool is_frozen = false;

    friend bool operator==(const DiscGroup&, const DiscGroup&) = default;
};
/// A disc of the start that became an obstacle, with the id that it had.
struct FrozenDisc {
    double id = 0, x = 0, y = 0, radius = 0;

    friend bool operator==(const FrozenDisc&, const FrozenDisc&) = default;
};

/// Each rank writes its own discs, or MPI-IO chooses ranks that write for all.
enum class Transfers { independent, collective };

/// `[output.checkpoint]`: when and where the state is stored; always at the end and on a signal.
struct CheckpointOutput {
    std::string folder; ///< in the run's folder
    std::optional<std::int64_t> every_steps;
    std::optional<double> every_minutes; ///< minutes of wall time
    std::int64_t keep = 2;               ///< older ones are removed
    bool at_end = true;
    Transfers transfers = Transfers::independent;
};

/// `[output.trajectory]`: frames in one file, at regular steps or at steps that grow by a factor.
struct TrajectoryOutput {
    std::string file; ///< in the run's folder
    std::int64_t every_steps = 1;
    std::int64_t frames_per_decade = 0; ///< 0: at regular steps
    bool has_position = true, has_velocity = true, has_collisions = false, has_psi6 = false,
         has_neighbours = false;
    bool has_image = false; ///< in a periodic box; true if the scene names no fields
    SideColumnSet columns;  ///< all that discs have, if the scene names no fields
    bool is_single = true;  ///< numbers of 4 bytes, otherwise of 8
};

/// `[output.collisions]`: every collision in one file.
struct CollisionOutput {
    std::string file;
};

/// `[output.measurements]`: what is sampled during the run, and where the tables go.
/// Quantities and their settings have the names of their declarations (scene/quantity.hpp).
struct MeasurementOutput {
    struct Number {
        double value = 0;
        bool is_given = false; ///< by the scene; otherwise a check has set it
    };

    std::string folder; ///< in the run's folder
    std::int64_t every_steps = 10, from_step = 0;
    std::vector<std::string> quantities;                 ///< in the order of the scene
    std::map<std::string, Number, std::less<>> settings; ///< the quantities' settings

    bool measures(std::string_view quantity) const {
        return std::find(quantities.begin(), quantities.end(), quantity) != quantities.end();
    }
    bool is_given(std::string_view setting) const {
        const auto found = settings.find(setting);
        return found != settings.end() && found->second.is_given;
    }
    void give(const std::string& setting, double value) { settings[setting] = {value, true}; }
    void derive(const std::string& setting, double value) { settings[setting] = {value, false}; }
};

/// `[time.stop]`: ends a run before its last step, at the end of a step in which a sync was.
struct StopConditions {
    std::optional<std::int64_t> collisions, departed; ///< numbers since the scene's start
    std::optional<double> temperature_below, temperature_above;
    std::optional<double> energy_below, energy_above;
    std::optional<double> pressure_below, pressure_above;

    bool are_any() const {
        return collisions || departed || temperature_below || temperature_above || energy_below ||
               energy_above || pressure_below || pressure_above;
    }
};

struct SceneParameters {
    std::string name; ///< the file's name, "standard input" for `-`
    std::string text; ///< the input's own text without lines of discs, for checkpoints
    std::int64_t lines_before_discs =
        0;                              ///< number of lines of legacy text before its list of discs
    bool discs_follow = false;          ///< legacy text goes on with lines of discs
    std::vector<std::string> overrides; ///< `key=value`, what was set on top of the text

    Box box;                               ///< the edges; 0 if they are not known
    Origin origin;                         ///< of places in texts, messages and tables alone
    double radius = 0;                     ///< r; the largest one of several species
    bool are_points = false;               ///< the scene says 0; `radius` is point_radius(box)
    std::optional<SizeDistribution> sizes; ///< that radii follow; they are species then
    std::uint64_t n_discs = 0;

    Generator generator = Generator::random;
    std::string discs_file; ///< for Generator::file, relative to the scene; empty if
                            ///< lines follow the header
    std::string discs_from; ///< an HDF5 file with the initial discs, relative to the scene
    std::optional<std::int64_t> discs_from_step; ///< the frame's step; else the last frame is used
    double speed = 1;                            ///< root mean square of the generated speeds
    std::optional<double> temperature;           ///< kT of generated discs, in place of the speed
    VelocityKind velocities = VelocityKind::maxwell;
    bool draws_velocities = false; ///< of listed discs, because `discs.speed` or
                                   ///< `discs.temperature` stand beside the list
    double growth_rate = 0.01;     ///< for Generator::compressed: the rate at which the
                                   ///< largest diameter grows, over the root mean square speed
    std::uint64_t seed = 3210;
    std::vector<Stream> streams;
    std::optional<StartRegion> region;    ///< of discs that have none of their own
    std::vector<RegionRun> regions;       ///< of species or groups, by ids; empty if none has one
    bool has_shares = false;              ///< in `discs.species`
    std::vector<DiscGroup> groups;        ///< in the order of ids: by species; of all discs, if any
    std::vector<StartRegion> freeze;      ///< discs that begin in one of these become obstacles
    std::vector<FrozenDisc> frozen;       ///< by ids; once they are found, the scene has them among
                                          ///< its obstacles, and its numbers are without them
    std::vector<InputDisc> listed_discs;  ///< discs written in the scene itself (`discs.list`)
    std::vector<DiscColumn> disc_columns; ///< `discs.columns`; see columns_of_lines
    FirstNumbers first_numbers;           ///< for columns beside the states

    std::int64_t steps = 0;
    Method method = Method::event_driven; ///< legacy text: time-stepped
    std::int64_t micro_steps = 1;
    std::int64_t sync_every = 64;
    Precision precision = Precision::double_;
    Arithmetic arithmetic = Arithmetic::stable;
    bool contraction = false; ///< in the products and sums of the naive formula
    std::optional<double> accuracy;
    bool gpu = false; ///< a GPU steps the discs
    StopConditions stop;
    /// Whether discs of the start become obstacles.
    bool freezes() const {
        return !freeze.empty() || std::ranges::any_of(groups, &DiscGroup::is_frozen);
    }
    bool awaits_frozen() const { return freezes() && frozen.empty(); }
    /// The last step that is sure to come: what is taken often enough up to there is never taken
    /// too rarely.
    std::int64_t least_last_step() const { return stop.are_any() ? 0 : steps; }

    Effects effects; ///< times in steps

    TextOutput text_output = TextOutput::none;
    std::string folder; ///< for all outputs, relative to the working folder; empty: none
    std::optional<CheckpointOutput> checkpoint; ///< set for each run with a folder
    std::optional<TrajectoryOutput> trajectory;
    std::string length_unit, time_unit; ///< `[output.units]`, for HDF5 files; empty: not known
    std::optional<CollisionOutput> collisions;
    std::optional<MeasurementOutput> measurements;
    std::int64_t averages_from = 0; ///< the first step of the report's averages

    std::vector<std::string> warnings; ///< legal but worth a line: K not a power of two, ...

    /// The area in which discs move, obstacles in it included.
    double area() const;
    /// The share of that area that the discs cover at the start.
    double packing() const;
    /// The packing at the end of the last step, for growing discs.
    double last_packing() const {
        const double growth = effects.growth_at(static_cast<double>(steps));
        return packing() * (growth * growth);
    }
    /// True if the discs come from lines of text: those of `discs_file`, or those
    /// after a legacy header.
    bool reads_disc_lines() const { return generator == Generator::file && listed_discs.empty(); }
};

/// The radius of equal discs that cover this share of the scene's area.
double radius_of_packing(const SceneParameters& scene, double packing);

/// The radius with which points are computed: a billionth of the box. So a place is on one side of
/// a wall for sure, whatever rounding does.
inline double point_radius(const Box& box) { return 0x1p-30 * box.longest(); }

/// Whether discs may begin with other numbers than 0 in a column.
bool has_first_numbers(const SceneParameters& scene, SideColumn column);
/// A disc's number at the start. Directions that the scene does not give are drawn by the seed of
/// the activity, so that any rank finds any disc's.
double first_number(const SceneParameters& scene, SideColumn column, DiscId id);

/// The columns beside the states that the scene's discs have: those that the dynamics
/// needs, and those to which the scene gives numbers.
SideColumnSet side_columns_of(const SceneParameters& scene);

/// Chooses the fields of frames for a scene that does not name them.
void choose_fields(TrajectoryOutput& trajectory, const SceneParameters& scene);

/// The path of `discs_file` or `discs_from`, which are relative to the scene's own file.
std::string discs_path(const SceneParameters& scene);

} // namespace carrom
