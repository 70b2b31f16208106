// SPDX-License-Identifier: BSD-3-Clause
// The declaration of an effect, such as gravity or a thermostat.
//
// Each file of this folder declares one effect: its tables, keys (and which of them are seeds),
// rules, checks, line in the summary, allowance in the self-check, energy besides the kinetic one,
// and action at syncs. The reader of scenes, the pages, reports, restarts, replicas, the self-check
// and the engines loop over `all_effects`, so none of them names a particular effect. Besides the
// discs' states and columns, a checkpoint contains the values that an effect keeps from sync to
// sync.
//
// The folder belongs to the scene because keys and rules are functions of SceneParameters. It uses
// src/dynamics, which has the code for each flight and collision, and the engines use it. So an
// effect that acts at syncs has its physics in its file here. An effect that acts in collisions or
// in flight has its physics in src/dynamics, and only its declaration here.
//
// To add an effect, write a file in this folder, and add its name to the list in
// src/scene/CMakeLists.txt.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <carrom/totals.hpp>

#include "core/axis.hpp"
#include "dynamics/sync_effect.hpp"
#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

/// Changes that the self-check must not report, because an effect causes them.
struct CheckAllowance {
    bool collisions_take_energy = false;
    bool walls_give_energy = false; ///< walls do work that is not known before the run
    bool acts_at_syncs = false;     ///< velocities change at syncs; the engine sums the energy gain
    /// Whether velocities change a second time, after outputs at a sync and before the next flights
    bool acts_before_flights = false;
    /// Whether surfaces do work in collisions: see EffectDeclaration::work_in_collision
    bool surfaces_give_energy = false;
};

/// A disc in the box. Its unit of time is that of the `Effects` that the same function receives.
struct ShownDisc {
    double x = 0, y = 0, vx = 0, vy = 0, spin = 0;
    SizeAndMass has;
    double sync_interval = 0; ///< time between syncs
    DiscId id = 0;
};

/// An energy of discs other than their kinetic energy. Totals and reports sum it over all discs in
/// the box, and so does the self-check unless `is_of_syncs` is set.
struct OtherEnergy {
    const char* name;       ///< the energy's name in the report
    const char* words;      ///< text after the value in the summary
    double Totals::* value; ///< stores the sum; energies with the same name share it
    double (*of_disc)(const ShownDisc&, const Effects&, const Box&);
    /// For a potential energy: its largest value for a disc of mass 1, which sets the scale of
    /// rounding errors. Null for other energies, and if `is_of_syncs` is set.
    double (*largest)(const Effects&, const Box&) = nullptr;
    /// Whether this energy turns into kinetic energy only at syncs. The engine adds up the kinetic
    /// energy that discs gain at syncs, so the self-check leaves this energy out.
    bool is_of_syncs = false;
};

/// The displacement of a disc between two inspections of the self-check, not wrapped into the box.
struct Way {
    double x = 0, y = 0;
    SizeAndMass has;
};

/// A number in the report and the summary about the state at the end of a run.
struct EndNumber {
    const char* name;  ///< the number's name in the report
    const char* label; ///< label of its line in the summary
    const char* words; ///< text after the value in the summary
    std::uint64_t value;
};

/// How an effect changes the total momentum of the discs along an axis.
struct CommonMotion {
    bool is_stopped = false; ///< discs give momentum to something that does not move with them
    bool is_driven = false;  ///< discs gain momentum in one direction
};

/// How the common velocity of all discs along an axis is treated.
enum class Drift : std::uint8_t {
    /// It counts as thermal motion, because the axis has walls, or because discs both give and
    /// receive momentum along it
    is_heat,
    is_kept,   ///< subtracted, because nothing stops it; N - 1 degrees of freedom are left
    is_driven, ///< subtracted, because it is a flow; velocities relative to it fluctuate
};

struct EffectDeclaration {
    std::vector<Table> tables = {};
    std::vector<Key> keys = {};
    std::vector<Rule> rules = {};
    /// Computes defaults that depend on the effect's numbers, before any check.
    void (*derive)(const SceneDraft&) = nullptr;
    /// The contents of a file that the scene names, as settings. Checkpoints store these, so that
    /// restarts do not need the file. Called on rank 0; throws InputError.
    std::vector<std::string> (*settings_of_file)(const SceneParameters&) = nullptr;
    /// Checks that involve several values: `check_times` checks times, and always runs;
    /// `check_room` runs only if box and discs are valid.
    void (*check_times)(const SceneDraft&) = nullptr;
    void (*check_room)(const SceneDraft&) = nullptr;
    /// The effect's text in the summary's line about effects; empty in a scene without the effect.
    std::string (*summary)(const Effects&) = nullptr;
    CheckAllowance (*allowance)(const Effects&) = nullptr;
    /// The effect's energy; nothing in a scene whose discs do not have this energy.
    std::optional<OtherEnergy> (*energy)(const Effects&) = nullptr;
    // The next three functions serve the self-check and use the micro-step as the unit of time. The
    // first returns an upper bound of the share of the kinetic energy that is left after `time`.
    double (*energy_left)(const Effects&, double time) = nullptr;
    /// The work that the effect does on a disc along this displacement.
    double (*work)(const Effects&, const Way&) = nullptr;
    /// The energy that moving surfaces give in a collision; `radii` is the sum of both radii.
    double (*work_in_collision)(const Effects&, double impulse, double radii) = nullptr;
    /// Whether discs may come to rest on each other or on a wall, so that a contact time is needed.
    bool (*lets_discs_rest)(const Effects&) = nullptr;
    /// A typical speed that the effect gives to discs, as a length per step.
    double (*usual_speed)(const SceneParameters&) = nullptr;
    /// The object that acts at syncs; nothing in a scene without the effect.
    std::unique_ptr<SyncEffect> (*at_syncs)(const SceneParameters&) = nullptr;
    /// The numbers at the end of a run, from the values that the effect kept after the last sync.
    std::vector<EndNumber> (*at_end)(std::span<const std::int64_t> kept) = nullptr;
    /// Whether the mean kinetic energy jumps at syncs, because the effect then reverses changes of
    /// the energy since the previous sync.
    bool (*makes_energy_jump)(const Effects&) = nullptr;
    /// How the effect changes the total momentum along a periodic axis, as a thermostat or a side
    /// with friction does; null if it does not.
    CommonMotion (*common_motion)(const Effects&, Axis) = nullptr;
    /// Whether the GPU kernels include the effect. If the function is missing, the effect cannot be
    /// combined with machine.gpu.
    bool (*runs_on_gpu)(const Effects&) = nullptr;
    /// Why Z is undefined in a scene with the effect; empty if it is defined.
    std::string (*reason_without_z)(const Effects&) = nullptr;
};

/// All effects in the order of the list in CMakeLists.txt; the reference page has the same order.
const std::vector<EffectDeclaration>& all_effects();

/// One line for a summary, such as "restitution 0.9 of pairs; drag 0.01"; empty if there
/// are no effects.
std::string summary_of(const Effects& effects);
/// The changes that these effects and sides of the box cause, for the self-check.
CheckAllowance allowance_of(const Effects& effects);
/// All energies of discs besides the kinetic energy, in the order of the effects.
std::vector<OtherEnergy> other_energies_of(const Effects& effects);
// `energy_left_by` is the product over all effects, the others are sums; see EffectDeclaration.
double energy_left_by(const Effects& effects, double time);
double work_on_way(const Effects& effects, const Way& way);
double work_in_collision(const Effects& effects, double impulse, double radii);
/// The largest of the typical speeds that effects give to discs, as a length per step.
double usual_speed_of_effects(const SceneParameters& scene);
/// `kept` is the list that Engine::kept_by_effects returns.
std::vector<EndNumber> end_numbers_of(const SceneParameters& scene,
                                      std::span<const std::int64_t> kept);
/// Why Z is undefined, from the first effect that has a reason; otherwise empty.
std::string reason_without_z(const Effects& effects);
/// Whether the mean kinetic energy jumps at syncs.
bool does_energy_jump(const Effects& effects);
/// Warns if the kinetic energy changes much between syncs, or if its mean over the samples is not
/// its mean over time.
void check_energy_jumps(const SceneDraft& draft);
/// How the common velocity of all discs along `axis` is treated in temperature, pressure and
/// displacements. No other function decides this.
Drift drift_along(Axis axis, const Effects& effects);
/// Why kT, P and Z are undefined for this number of discs; empty if they are defined. A single disc
/// has no velocity relative to the centre of mass, and so no temperature along a periodic axis on
/// which nothing stops the common motion.
std::string reason_without_temperature(const Effects& effects, std::uint64_t n_discs);
/// The settings from all files of effects. Called on rank 0; throws InputError.
std::vector<std::string> settings_of_effect_files(const SceneParameters& scene);
/// The effects at syncs, in the order in which they act.
SyncEffects sync_effects_of(const SceneParameters& scene);

} // namespace carrom
