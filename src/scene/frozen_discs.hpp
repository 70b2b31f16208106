// SPDX-License-Identifier: BSD-3-Clause
// Discs of the initial state that became fixed bodies: `discs.freeze`, and `freeze = true` in a
// group.
//
// They are known when all discs have their initial positions. From then on they are fixed bodies of
// the scene and no longer discs. The setting `discs.frozen` lists them. Checkpoints store settings,
// so a restart does not need to generate the initial state again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

std::vector<Key> keys_of_freezing();

/// Why these discs, in order of id, cannot be fixed bodies; empty if they can.
std::string problem_of_frozen(const SceneParameters& scene, const std::vector<FrozenDisc>& frozen);

/// Makes the discs fixed bodies, and adds the setting that lists them. The scene must have a key
/// that freezes discs, and no frozen discs yet. `has_others_alone`: the scene's species already
/// exclude the frozen discs, because they were read from a checkpoint of the moving discs.
void set_frozen(SceneParameters& scene, std::vector<FrozenDisc> frozen,
                bool has_others_alone = false);

/// Whether this is the setting that set_frozen adds.
bool is_of_frozen(std::string_view setting);

/// Checks the regions of `discs.freeze`.
void check_freezing(const SceneDraft& draft);

/// Checks the discs in the setting `discs.frozen`, and makes them fixed bodies if no check failed.
void take_frozen(const SceneDraft& draft);

} // namespace carrom
