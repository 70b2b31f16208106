// SPDX-License-Identifier: BSD-3-Clause
// What an effect says of itself, in one place.
//
// Each file of this folder declares one effect: its tables, keys (a key says by itself whether it
// is a seed), rules, checks, line in the summary, allowance in the self-check, energy beside that
// of motion, and what it does at syncs. The reader of scenes, the pages, reports, restarts,
// replicas, the self-check and the engines loop over `all_effects`, and name no effect. Beside the
// discs' states and columns, a checkpoint has what an effect at syncs says that it keeps.
//
// The folder belongs to the scene because keys and rules are functions of SceneParameters. It is
// above the dynamics, where the templates of the hot paths are, and below the engines. So an effect
// that acts at syncs has its physics in its own file here; one that acts in collisions or in flight
// has its physics in src/dynamics, and its words here.
//
// To add an effect: a file in this folder, and its name in the list of src/scene/CMakeLists.txt.
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

/// What the self-check cannot hold against a run, because the effect does it.
struct CheckAllowance {
    bool collisions_take_energy = false;
    bool walls_give_energy = false; ///< an amount that only the run knows
    bool acts_at_syncs = false; ///< velocities change there, by an energy that the engine adds up
    bool acts_before_flights = false;  ///< and again right before the flights that follow
    bool surfaces_give_energy = false; ///< in collisions: see EffectDeclaration::work_in_collision
};

/// A disc as the box sees it. The unit of time is that of the effects beside it.
struct ShownDisc {
    double x = 0, y = 0, vx = 0, vy = 0, spin = 0;
    SizeAndMass has;
    double sync_interval = 0; ///< the time between syncs
    DiscId id = 0;
};

/// An energy that discs have beside that of their motion. Totals, reports and the self-check add it
/// up for all discs in the box.
struct OtherEnergy {
    const char* name;       ///< in the report
    const char* words;      ///< in the summary, after its value
    double Totals::* value; ///< features of one name share it
    double (*of_disc)(const ShownDisc&, const Effects&, const Box&);
    /// Of an energy of places: what it can be for a mass of 1, to hold rounding against.
    double (*largest)(const Effects&, const Box&) = nullptr;
    /// It turns into energy of motion at syncs alone, where the engine adds up what discs get; so
    /// the self-check leaves it out.
    bool is_of_syncs = false;
};

/// The way of a disc between two inspections of the self-check, round periodic sides, too.
struct Way {
    double x = 0, y = 0;
    SizeAndMass has;
};

/// A number of the state at the end of a run.
struct EndNumber {
    const char* name;  ///< in the report
    const char* label; ///< of its line in the summary
    const char* words; ///< in the summary, after its value
    std::uint64_t value;
};

/// What an effect does to the momentum of all discs along an axis.
struct CommonMotion {
    bool is_stopped = false; ///< discs give momentum to something that does not move with them
    bool is_driven = false;  ///< discs get momentum all in one direction
};

/// How a velocity that all discs have in common counts.
enum class Drift : std::uint8_t {
    is_heat,   ///< in the temperature, because the axis has walls, or momentum goes to and fro
    is_kept,   ///< apart from it, because nothing stops it: it has one of N degrees of freedom
    is_driven, ///< apart from it, because it is a flow; what is about it fluctuates
};

struct EffectDeclaration {
    std::vector<Table> tables = {};
    std::vector<Key> keys = {};
    std::vector<Rule> rules = {};
    /// Defaults that depend on its numbers, before any check.
    void (*derive)(const SceneDraft&) = nullptr;
    /// What a file that the scene names says, as settings that checkpoints keep, so that restarts
    /// need no file. Called on rank 0; throws InputError.
    std::vector<std::string> (*settings_of_file)(const SceneParameters&) = nullptr;
    /// Checks of more than one number: of times, and of what depends on a right box and discs.
    void (*check_times)(const SceneDraft&) = nullptr;
    void (*check_room)(const SceneDraft&) = nullptr;
    /// Its part of the line about effects; empty in a scene without it.
    std::string (*summary)(const Effects&) = nullptr;
    CheckAllowance (*allowance)(const Effects&) = nullptr;
    /// Nothing in a scene whose discs do not have it.
    std::optional<OtherEnergy> (*energy)(const Effects&) = nullptr;
    // For the self-check, per micro-step: what the effect gives to discs that is no change of such
    // an energy.
    /// The share of the energy of motion that is left after a time.
    double (*energy_left)(const Effects&, double time) = nullptr;
    /// The energy that a disc gets on its way.
    double (*work)(const Effects&, const Way&) = nullptr;
    /// The energy that surfaces give in a collision of this impulse, with the sum of the radii.
    double (*work_in_collision)(const Effects&, double impulse, double radii) = nullptr;
    /// Whether discs may come to rest on each other, or on a wall, so that they need a contact
    /// time.
    bool (*lets_discs_rest)(const Effects&) = nullptr;
    /// A speed per step that it is likely to give to discs.
    double (*usual_speed)(const SceneParameters&) = nullptr;
    /// Nothing in a scene without it.
    std::unique_ptr<SyncEffect> (*at_syncs)(const SceneParameters&) = nullptr;
    /// Of an effect at syncs, from what it keeps after the last one.
    EndNumber (*at_end)(std::span<const std::int64_t> kept) = nullptr;
    /// Whether it keeps the mean energy of motion only together with what acts between syncs, so
    /// that this energy jumps at each sync.
    bool (*makes_energy_jump)(const Effects&) = nullptr;
    /// Of an effect that exchanges momentum with discs other than by the sides that end an axis.
    CommonMotion (*common_motion)(const Effects&, Axis) = nullptr;
    /// Whether kernels of GPUs have it; those that say nothing are errors with machine.gpu.
    bool (*runs_on_gpu)(const Effects&) = nullptr;
    /// Why Z means nothing in a scene with the effect; empty if it means something.
    std::string (*reason_without_z)(const Effects&) = nullptr;
};

/// In the order of the list, which is that of the reference.
const std::vector<EffectDeclaration>& all_effects();

/// One line for a summary, as in "restitution 0.9 of pairs; gravity (0, -0.001)"; empty where there
/// are none.
std::string summary_of(const Effects& effects);
/// What the self-check cannot hold against a run with these effects and sides of the box.
CheckAllowance allowance_of(const Effects& effects);
/// In the order of the effects.
std::vector<OtherEnergy> other_energies_of(const Effects& effects);
// Of all effects together: see EffectDeclaration.
double energy_left_by(const Effects& effects, double time);
double work_on_way(const Effects& effects, const Way& way);
double work_in_collision(const Effects& effects, double impulse, double radii);
/// The largest of all effects'.
double usual_speed_of_effects(const SceneParameters& scene);
/// `kept` is Engine::kept_by_effects.
std::vector<EndNumber> end_numbers_of(const SceneParameters& scene,
                                      std::span<const std::int64_t> kept);
/// Why Z is undefined, from the first effect that has a reason; otherwise empty.
std::string reason_without_z(const Effects& effects);
/// Whether the mean energy of motion jumps at syncs.
bool does_energy_jump(const Effects& effects);
/// Warns where it changes much between syncs, or where samples do not have its mean over time.
void check_energy_jumps(const SceneDraft& draft);
/// How the common velocity of all discs along `axis` counts. Temperature, pressure and
/// displacements follow this alone.
Drift drift_along(Axis axis, const Effects& effects);
/// Why kT, P and Z are undefined for so many discs; empty if they are defined. One disc that
/// nothing stops along an axis has no velocity there but the common one.
std::string reason_without_temperature(const Effects& effects, std::uint64_t n_discs);
/// What all files of effects say. Called on rank 0; throws InputError.
std::vector<std::string> settings_of_effect_files(const SceneParameters& scene);
/// In the order in which they act.
SyncEffects sync_effects_of(const SceneParameters& scene);

} // namespace carrom
