// SPDX-License-Identifier: BSD-3-Clause
// The declaration of an effect, such as gravity or a thermostat.
//
// Each file of this folder declares one effect: its tables, keys (and which of them are seeds),
// rules, checks, line in the summary, allowance in the self-check, energy besides the kinetic one,
// and action at syncs. The reader of scenes, the pages, reports, restarts, replicas, the self-check
// and the engines loop over `all_effects`, so they contain the name of no effect. Besides the
// discs' states and columns, a checkpoint contains the values that an effect keeps from sync to
// sync.
//
// The folder belongs to the scene because keys and rules are functions of SceneParameters. It uses
// the dynamics, where the templates of the hot paths are, and the engines use it. So an effect
// that acts at syncs has its physics in its file here. An effect that acts in collisions or in
// flight has its physics in src/dynamics, and only its declaration here.
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
    bool walls_give_energy = false; ///< walls do work; the amount is only known during the run
    bool acts_at_syncs = false;     ///< velocities change at syncs; the engine sums the energy gain
    /// Whether velocities change again between the state at a sync and the flights after it
    bool acts_before_flights = false;
    /// Whether surfaces do work in collisions: see EffectDeclaration::work_in_collision
    bool surfaces_give_energy = false;
};

/// A disc in the box. Its unit of time is that of the Effects that a function gets along with it.
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
    double Totals::* value; ///< where the sum is kept; effects with the same name share it
    double (*of_disc)(const ShownDisc&, const Effects&, const Box&);
    /// For an energy of position: its largest value for a disc of mass 1, which sets the scale of
    /// rounding errors. Null for other energies, and where `is_of_syncs` is set.
    double (*largest)(const Effects&, const Box&) = nullptr;
    /// Whether this energy turns into kinetic energy only at syncs. The engine sums up what discs
    /// gain there, so the self-check leaves this energy out.
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

/// How an effect changes the momentum of all discs along an axis.
struct CommonMotion {
    bool is_stopped = false; ///< discs give momentum to something that does not move with them
    bool is_driven = false;  ///< discs gain momentum in one direction
};

/// How the common velocity of all discs along an axis is treated.
enum class Drift : std::uint8_t {
    /// Part of the temperature, because the axis has walls, or because momentum is exchanged in
    /// both directions
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
    /// The kinetic energy that the effect gives to a disc along its displacement.
    double (*work)(const Effects&, const Way&) = nullptr;
    /// The energy that surfaces give in a collision with this impulse and sum of radii.
    double (*work_in_collision)(const Effects&, double impulse, double radii) = nullptr;
    /// Whether discs may come to rest on each other or on a wall, so that a contact time is needed.
    bool (*lets_discs_rest)(const Effects&) = nullptr;
    /// A typical speed, per step, that the effect gives to discs.
    double (*usual_speed)(const SceneParameters&) = nullptr;
    /// The object that acts at syncs; nothing in a scene without the effect.
    std::unique_ptr<SyncEffect> (*at_syncs)(const SceneParameters&) = nullptr;
    /// The numbers at the end of a run, from the values that the effect kept after the last sync.
    std::vector<EndNumber> (*at_end)(std::span<const std::int64_t> kept) = nullptr;
    /// Whether the effect reverses, at each sync, changes of energy since the sync before, so that
    /// the mean kinetic energy jumps there.
    bool (*makes_energy_jump)(const Effects&) = nullptr;
    /// How the effect exchanges momentum with all discs along a periodic axis, for example by a
    /// thermostat or by sides that rub; null if it does not.
    CommonMotion (*common_motion)(const Effects&, Axis) = nullptr;
    /// Whether kernels of GPUs contain the effect. If the function is missing, the effect cannot be
    /// combined with machine.gpu.
    bool (*runs_on_gpu)(const Effects&) = nullptr;
    /// Why Z is undefined in a scene with the effect; empty if it is defined.
    std::string (*reason_without_z)(const Effects&) = nullptr;
};

/// All effects in the order of the list in CMakeLists.txt, as on the reference page.
const std::vector<EffectDeclaration>& all_effects();

/// One line for a summary, such as "restitution 0.9 of pairs; drag 0.01"; empty if there
/// are no effects.
std::string summary_of(const Effects& effects);
/// The changes that these effects and sides of the box cause, for the self-check.
CheckAllowance allowance_of(const Effects& effects);
/// The energies other than kinetic energy, in the order of the effects.
std::vector<OtherEnergy> other_energies_of(const Effects& effects);
// For each of these functions: the product or the sum over all effects; see EffectDeclaration.
double energy_left_by(const Effects& effects, double time);
double work_on_way(const Effects& effects, const Way& way);
double work_in_collision(const Effects& effects, double impulse, double radii);
/// The largest typical speed of all effects.
double usual_speed_of_effects(const SceneParameters& scene);
/// `kept` is the list that Engine::kept_by_effects returns.
std::vector<EndNumber> end_numbers_of(const SceneParameters& scene,
                                      std::span<const std::int64_t> kept);
/// Why Z is undefined, from the first effect that has a reason; otherwise empty.
std::string reason_without_z(const Effects& effects);
/// Whether the mean kinetic energy jumps at syncs.
bool does_energy_jump(const Effects& effects);
/// Warns if the kinetic energy changes much between syncs, or if the samples' mean of it is not the
/// mean over time.
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
