// SPDX-License-Identifier: BSD-3-Clause
// One checked description of a run. Every reader of inputs makes a `SceneParameters`, and nothing
// reads the text of the input afterwards.
//
// Velocities and times are in the scene's unit of time, the step. The engine divides velocities by
// `micro_steps` when it receives the discs.
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

#include "core/computed_fields.hpp"
#include "core/disc_state.hpp"
#include "dynamics/effects.hpp"
#include "scene/size_distribution.hpp"

namespace carrom {

enum class Method { time_stepped, event_driven };
/// The precision of stored states and of computation.
enum class Precision { double_, single };
/// The formula for the times of contacts: numerically stable, or as in the course program.
enum class Arithmetic { stable, naive };
enum class Generator { random, lattice, triangular, compressed, legacy, file };
enum class VelocityKind {
    maxwell,
    uniform,
    reversed ///< the listed velocities and spins with the opposite sign
};

/// Which steps print lines of discs on standard output: none, steps 0 and S (the course program's
/// `perf`), or every step (its `print`).
enum class TextOutput { none, first_and_last, every_step };

/// A disc of an input, with its velocity per step.
struct InputDisc {
    DiscId id = 0;
    double x = 0, y = 0, vx = 0, vy = 0;

    friend bool operator==(const InputDisc&, const InputDisc&) = default;
};

/// Discs with consecutive ids, up to `end` - 1, that start with the same number in a side column
/// (core/side_columns.hpp). Rates are per step.
struct NumberRun {
    DiscId end = 0;
    double number = 0;

    friend bool operator==(const NumberRun&, const NumberRun&) = default;
};
/// The initial numbers of side columns, in order of id; empty for a column that is not given.
using FirstNumbers = BySideColumn<std::vector<NumberRun>>;

/// The columns that a line of discs may have. Side columns follow from `first_side` on.
enum class DiscColumn : std::size_t { id, x, y, vx, vy, radius, mass, first_side };

constexpr DiscColumn disc_column_of(SideColumn column) {
    return static_cast<DiscColumn>(static_cast<std::size_t>(DiscColumn::first_side) +
                                   static_cast<std::size_t>(column));
}
/// The inverse of disc_column_of; only for side columns.
constexpr SideColumn side_column_of(DiscColumn column) {
    return static_cast<SideColumn>(static_cast<std::size_t>(column) -
                                   static_cast<std::size_t>(DiscColumn::first_side));
}

/// The point that has the coordinates (0, 0) for users, relative to the lower left corner of the
/// box. In computations this corner is (0, 0) (scene/places.hpp).
struct Origin {
    double x = 0, y = 0;
    bool is_centre = false; ///< the centre of the box; x and y are set when the box is known

    bool is_on() const { return x != 0 || y != 0; }
    friend bool operator==(const Origin& a, const Origin& b) { return a.x == b.x && a.y == b.y; }
};

/// A rectangle, and a velocity that is added to the drawn velocities of discs in it, for example
/// for a jet or a moving slab.
struct Stream {
    double x_low = 0, y_low = 0, x_high = 0, y_high = 0;
    double vx = 0, vy = 0;
};

/// A rectangle that contains discs at the start: as a whole, or for `freeze` only their centres.
struct StartRegion {
    double x_low = 0, y_low = 0, x_high = 0, y_high = 0;

    friend bool operator==(const StartRegion&, const StartRegion&) = default;
};
/// Discs with consecutive ids, up to `end` - 1, that start in the same region, if it is set.
struct RegionRun {
    DiscId end = 0;
    std::optional<StartRegion> region;

    friend bool operator==(const RegionRun&, const RegionRun&) = default;
};

/// Discs of one species that are generated in the same way, with consecutive ids.
struct DiscGroup {
    std::uint64_t count = 0;
    std::size_t species = 0; ///< row of `discs.species`, counted from 0
    std::optional<StartRegion> region;
    std::optional<double> temperature, speed; ///< kT, or root mean square speed; unset: the scene's
    Generator generator = Generator::random;
    bool is_frozen = false;

    friend bool operator==(const DiscGroup&, const DiscGroup&) = default;
};
/// A disc of the initial state that became a fixed body, with the id that it had as a disc.
struct FrozenDisc {
    double id = 0, x = 0, y = 0, radius = 0;

    friend bool operator==(const FrozenDisc&, const FrozenDisc&) = default;
};

/// Who writes a checkpoint: each rank its own discs, or for all ranks some that MPI-IO chooses.
enum class Transfers { independent, collective };

/// `[output.checkpoint]`: when and where the state is stored, besides at the end and on a signal.
struct CheckpointOutput {
    std::string folder; ///< path in the run's folder, relative to the working folder
    std::optional<std::int64_t> every_steps;
    std::optional<double> every_minutes; ///< wall time in minutes
    std::int64_t keep = 2;               ///< number of checkpoints kept; older ones are removed
    bool at_end = true;
    Transfers transfers = Transfers::independent;
};

/// `[output.trajectory]`: frames in one file, at regular steps or at steps that grow by a factor.
struct TrajectoryOutput {
    std::string file; ///< path in the run's folder, relative to the working folder
    std::int64_t every_steps = 1;
    std::int64_t frames_per_decade = 0; ///< 0: frames at regular steps
    bool has_position = true, has_velocity = true, has_collisions = false;
    bool has_image = false;      ///< image counts; by default in periodic boxes without shear
    ComputedFieldSet computed{}; ///< none if the scene lists no fields
    SideColumnSet columns;       ///< all columns of the discs, if the scene lists no fields
    bool is_single = true;       ///< numbers of 4 bytes instead of 8
};

/// `[output.collisions]`: every collision in one file.
struct CollisionOutput {
    std::string file;
};

/// `[output.measurements]`: the quantities that are sampled during the run, and the folder of their
/// tables. Quantities and their settings have the names of their declarations (scene/quantity.hpp).
struct MeasurementOutput {
    struct Number {
        double value = 0;
        bool is_given = false; ///< given by the scene; otherwise computed by a check
    };

    std::string folder; ///< path in the run's folder, relative to the working folder
    std::int64_t every_steps = 10, from_step = 0;
    /// Names of quantities in the order of the scene
    std::vector<std::string> quantities;
    std::map<std::string, Number, std::less<>> settings; ///< settings of the quantities, by name

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

/// `[time.stop]`: conditions that end a run early. They are tested after steps that have a sync.
struct StopConditions {
    std::optional<std::int64_t> collisions, departed; ///< counts since step 0
    std::optional<double> temperature_below, temperature_above;
    std::optional<double> energy_below, energy_above;
    std::optional<double> pressure_below, pressure_above;

    bool are_any() const {
        return collisions || departed || temperature_below || temperature_above || energy_below ||
               energy_above || pressure_below || pressure_above;
    }
};

struct SceneParameters {
    std::string name; ///< path of the file, or "standard input" for `-`
    std::string text; ///< text of the input without lines of discs, for checkpoints
    /// Number of lines of legacy text before its list of discs
    std::int64_t lines_before_discs = 0;
    bool discs_follow = false;          ///< lines of discs follow: legacy text or `discs.from`
    std::vector<std::string> overrides; ///< settings `key=value` that replace those of the text

    Box box;                 ///< lengths of the edges; 0 if they are not known
    Origin origin;           ///< the point that is (0, 0) for users; not used by computations
    double radius = 0;       ///< radius of the largest disc
    bool are_points = false; ///< the scene has the radius 0; `radius` is then point_radius(box)
    std::optional<SizeDistribution> sizes; ///< distribution of radii; determines the species
    std::uint64_t n_discs = 0;

    Generator generator = Generator::random;
    /// Path of `discs.file`, relative to the scene; empty if the scene has no such file
    std::string discs_file;
    std::string discs_from; ///< path of an HDF5 file with the discs, relative to the scene
    std::optional<std::int64_t> discs_from_step; ///< step of the frame; unset: the last frame
    double speed = 1;                            ///< mass-weighted root mean square of drawn speeds
    std::optional<double> temperature;           ///< kT of drawn velocities, instead of the speed
    VelocityKind velocities = VelocityKind::maxwell;
    /// Velocities of listed discs are drawn, because the scene gives `discs.speed` or
    /// `discs.temperature` for the list
    bool draws_velocities = false;
    /// For Generator::compressed: growth rate of the largest diameter, relative to the root mean
    /// square speed
    double compression_rate = 0.01;
    std::uint64_t seed = 3210;
    std::vector<Stream> streams;
    std::optional<StartRegion> region; ///< region for discs without a region of their own
    /// Regions of species or groups, in order of id; empty if there are none
    std::vector<RegionRun> regions;
    bool has_shares = false; ///< whether rows of `discs.species` give shares in place of counts
    /// Groups by species, in order of id; every disc is in a group, or the list is empty
    std::vector<DiscGroup> groups;
    /// Discs that start with their centres in these regions become fixed bodies
    std::vector<StartRegion> freeze;
    /// Frozen discs in order of id. Once they are known, they are fixed bodies of the scene, and
    /// its counts of discs do not include them
    std::vector<FrozenDisc> frozen;
    std::vector<InputDisc> listed_discs;  ///< discs written in the scene itself (`discs.list`)
    std::vector<DiscColumn> disc_columns; ///< `discs.columns`; see columns_of_lines
    FirstNumbers first_numbers;           ///< initial values of the side columns

    std::int64_t steps = 0;
    Method method = Method::event_driven; ///< legacy text is time-stepped
    std::int64_t micro_steps = 1;
    std::int64_t sync_every = 64;
    Precision precision = Precision::double_;
    Arithmetic arithmetic = Arithmetic::stable;
    bool contraction = false; ///< the naive formula uses fused multiply-add
    std::optional<double> accuracy;
    bool gpu = false; ///< a GPU runs the steps
    StopConditions stop;
    /// Whether discs of the initial state become fixed bodies.
    bool freezes() const {
        return !freeze.empty() || std::ranges::any_of(groups, &DiscGroup::is_frozen);
    }
    bool awaits_frozen() const { return freezes() && frozen.empty(); }
    /// The last step that the run is certain to reach: 0 if a condition may end the run before
    /// `steps`. Automatic choices of the time between samples depend on it.
    std::int64_t least_last_step() const { return stop.are_any() ? 0 : steps; }

    Effects effects; ///< effects with the step as the unit of time

    TextOutput text_output = TextOutput::none;
    std::string folder; ///< folder of all outputs, relative to the working folder; empty: none
    std::optional<CheckpointOutput> checkpoint; ///< set for every run with a folder
    std::optional<TrajectoryOutput> trajectory;
    std::string length_unit, time_unit; ///< `[output.units]`, for HDF5 files; empty: unknown
    std::optional<CollisionOutput> collisions;
    std::optional<MeasurementOutput> measurements;
    std::int64_t averages_from = 0; ///< first step of the report's averages

    /// Texts about settings that are allowed but doubtful, such as a number of micro-steps that is
    /// not a power of two
    std::vector<std::string> warnings;

    /// The area in which discs move; fixed bodies in it are not subtracted.
    double area() const;
    /// The share of `area()` that the discs cover at the start.
    double packing() const;
    /// The packing at the end of the last step, which differs for growing discs.
    double last_packing() const {
        const double size = effects.size_at(static_cast<double>(steps));
        return packing() * (size * size);
    }
    /// Whether discs are read from lines: of `discs_file`, `discs_from`, or after a legacy header.
    bool reads_disc_lines() const { return generator == Generator::file && listed_discs.empty(); }
};

/// The radius of equal discs whose packing in the scene is `packing`.
double radius_of_packing(const SceneParameters& scene, double packing);

/// The radius that stands for points, about a billionth of the box's longer edge. It is larger than
/// the rounding of any position, so a disc is always on one side of a wall.
inline double point_radius(const Box& box) { return 0x1p-30 * box.longest(); }

/// Whether discs may start with nonzero numbers in a column.
bool has_first_numbers(const SceneParameters& scene, SideColumn column);
/// A disc's initial number in a column. A direction that the scene does not give is drawn from the
/// seed of the activity and the id, so that any rank can compute it for any disc.
double first_number(const SceneParameters& scene, SideColumn column, DiscId id);

/// The side columns of the scene's discs: those that the dynamics needs, and those with numbers in
/// the scene.
SideColumnSet side_columns_of(const SceneParameters& scene);

/// Chooses the fields of frames for a scene that does not list them.
void choose_fields(TrajectoryOutput& trajectory, const SceneParameters& scene);

/// The path of `discs_file` or `discs_from`, which are relative to the scene's own file.
std::string discs_path(const SceneParameters& scene);

} // namespace carrom
