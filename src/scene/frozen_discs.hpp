// SPDX-License-Identifier: BSD-3-Clause
// Discs of the initial state that became fixed bodies: `discs.freeze`, and `freeze = true` in a
// group.
//
// They are known when the discs have positions. From then on they are fixed bodies of the scene,
// which contains only the other discs. A setting, `discs.frozen`, lists them. Checkpoints store
// settings, so a restart need not make the initial state again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

std::vector<Key> keys_of_freezing();

/// Why these discs, in the order of ids, cannot be fixed bodies; empty if they can.
std::string problem_of_frozen(const SceneParameters& scene, const std::vector<FrozenDisc>& frozen);

/// Makes the discs fixed bodies, and adds the setting that lists them. For a scene that freezes
/// discs but does not contain them yet. `has_others_alone`: its species no longer include the
/// frozen discs, because they were stored for the moving discs.
void set_frozen(SceneParameters& scene, std::vector<FrozenDisc> frozen,
                bool has_others_alone = false);

/// Whether a setting is the one that set_frozen adds.
bool is_of_frozen(std::string_view setting);

/// Checks the regions of `discs.freeze`.
void check_freezing(const SceneDraft& draft);

/// Makes the discs of the setting `discs.frozen` fixed bodies, after all other checks.
void take_frozen(const SceneDraft& draft);

} // namespace carrom
