// SPDX-License-Identifier: BSD-3-Clause
// What a kind of side of the box says of itself, in one place.
//
// Each kind is declared by one file of this folder: its keys, rules, checks, line in the summary
// and allowance in the self-check. The reader of scenes, the pages, reports and the self-check loop
// over `all_boundaries`, and name no kind. How discs meet a side is physics, and stands in
// dynamics/boundaries.hpp for both methods.
//
// To add a kind: a file in this folder, its name in the list of src/scene/CMakeLists.txt, a value
// and a word beside it in dynamics/effects.hpp, and what `Boundaries::rebound` does.
#pragma once

#include <string>
#include <vector>

#include "scene/effects/effect.hpp"
#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

struct BoundaryDeclaration {
    BoundaryKind kind;
    std::string_view help; ///< what a side of this kind is, for the page of keys
    /// Whether discs bounce off it, so that `restitution` has a meaning.
    bool has_restitution = false;
    // What other features ask of a side: a kind that does not say that it can, does not go with
    // them.
    bool is_at_rest = true;                         ///< its line stays where it is
    bool takes_growing_discs = false;               ///< a disc may grow towards it
    bool (*runs_on_gpu)(const Boundary&) = nullptr; ///< see EffectDeclaration
    /// Keys of one side, such as box.left.speed.
    std::vector<Key> (*keys_of_side)(std::size_t side) = nullptr;
    /// Tables and keys that all sides of this kind share.
    std::vector<Table> tables = {};
    std::vector<Key> keys = {};
    std::vector<Rule> rules = {};
    /// Checks of more than one number: of times, and of what depends on a right box and discs.
    void (*check_times)(const SceneDraft&) = nullptr;
    void (*check_room)(const SceneDraft&) = nullptr;
    /// Its part of the line about effects, for the side of that name.
    std::string (*summary)(const Boundary&, std::string_view name) = nullptr;
    CheckAllowance (*allowance)(const Boundary&) = nullptr;
};

/// In the order of the list, which is that of the reference.
const std::vector<BoundaryDeclaration>& all_boundaries();

/// The keys of all four sides, side by side.
std::vector<Key> keys_of_boundaries();
/// "left wall of restitution 0.9; top side open"; empty if all sides are elastic walls.
std::string summary_of_boundaries(const Effects& effects);
CheckAllowance allowance_of_boundaries(const Effects& effects);
/// Whether all sides have what growing discs need: see BoundaryDeclaration.
bool do_sides_take_growing_discs(const Effects& effects);
bool are_walls_at_rest(const Effects& effects);

/// "box.left.speed" for side 0 and "speed".
std::string side_key(std::size_t side, std::string_view name);
/// The condition of a key that has a meaning for one kind of side only.
Need side_needs(std::size_t side, BoundaryKind kind);
/// " of restitution 0.9" for summaries; empty if the wall is elastic.
std::string loss_text(const Boundary& side);
/// Whether the discs may fit into a box of this width and height.
bool has_room(const SceneParameters& scene, double width, double height);

} // namespace carrom
