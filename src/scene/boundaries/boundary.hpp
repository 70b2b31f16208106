// SPDX-License-Identifier: BSD-3-Clause
// The declaration of a kind of box side, such as a wall or an open side.
//
// Each file of this folder declares one kind: its keys, rules, checks, line in the summary and
// allowance in the self-check. The reader of scenes, the pages, reports and the self-check loop
// over `all_boundaries`, so their code names no kind. The physics of a bounce is in
// dynamics/boundaries.hpp, for the time-stepped and the event-driven method.
//
// To add a kind: write a file in this folder, add its name to the list in src/scene/CMakeLists.txt,
// add a value and a word to dynamics/effects.hpp, and add its physics to `Boundaries::rebound`.
#pragma once

#include <string>
#include <vector>

#include "scene/effects/effect.hpp"
#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

struct BoundaryDeclaration {
    BoundaryKind kind;
    std::string_view help; ///< description of a side of this kind, for the page of keys
    /// Whether discs bounce off the side, so that `restitution` applies to it.
    bool has_restitution = false;
    // Properties that other features depend on. A feature that requires one of them, such as
    // `takes_growing_discs`, cannot be combined with a kind that lacks it.
    bool is_at_rest = true;                         ///< the side never moves
    bool lets_discs_rest = false;                   ///< see EffectDeclaration::lets_discs_rest
    bool takes_growing_discs = false;               ///< growing discs may touch it
    bool (*runs_on_gpu)(const Boundary&) = nullptr; ///< see EffectDeclaration::runs_on_gpu
    /// Keys of one side, such as box.left.speed.
    std::vector<Key> (*keys_of_side)(std::size_t side) = nullptr;
    /// Tables and keys that all sides of this kind have in common.
    std::vector<Table> tables = {};
    std::vector<Key> keys = {};
    std::vector<Rule> rules = {};
    /// Checks that involve several values: `check_times` checks times, and always runs;
    /// `check_room` runs only if box and discs are valid.
    void (*check_times)(const SceneDraft&) = nullptr;
    void (*check_room)(const SceneDraft&) = nullptr;
    /// The text in the summary's line about effects, for a side called `name`.
    std::string (*summary)(const Boundary&, std::string_view name) = nullptr;
    CheckAllowance (*allowance)(const Boundary&) = nullptr;
};

/// All kinds in the order of the list in CMakeLists.txt; the reference page has the same order.
const std::vector<BoundaryDeclaration>& all_boundaries();

/// The keys of all four sides, ordered by side.
std::vector<Key> keys_of_boundaries();
/// Text such as "left wall of restitution 0.9; top side open"; empty if all sides are elastic
/// walls.
std::string summary_of_boundaries(const Effects& effects);
CheckAllowance allowance_of_boundaries(const Effects& effects);
/// Whether growing discs may touch every side (BoundaryDeclaration::takes_growing_discs).
bool do_sides_take_growing_discs(const Effects& effects);
bool are_walls_at_rest(const Effects& effects);
bool do_sides_let_discs_rest(const Effects& effects);

/// The name of a side's key: side 0 and "speed" give "box.left.speed".
std::string side_key(std::size_t side, std::string_view name);
/// The condition of a key that has a meaning only if the side's kind has `has_restitution`.
Need side_reflects(std::size_t side);
/// The condition of a key that has a meaning only if the side is of this kind.
Need side_needs(std::size_t side, BoundaryKind kind);
/// Text such as " of restitution 0.9" for summaries; empty if the wall is elastic.
std::string loss_text(const Boundary& side);
/// Whether discs may fit into such a box, judged by their total area and by the largest diameter.
bool has_room(const SceneParameters& scene, double width, double height);

} // namespace carrom
