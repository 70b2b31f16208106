// SPDX-License-Identifier: BSD-3-Clause
// Discs of the start that became obstacles: `discs.freeze`, and `freeze = true` in a group.
//
// They are known once the discs have places. From then on the scene has them among its obstacles,
// has the other discs alone, and names them by a setting, `discs.frozen`. Checkpoints keep
// settings, so a restart does not have to make the start again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

std::vector<Key> keys_of_freezing();

/// Why these discs, in the order of ids, cannot be obstacles of the others, or empty.
std::string problem_of_frozen(const SceneParameters& scene, const std::vector<FrozenDisc>& frozen);

/// Makes the discs obstacles, and adds the setting that names them. For a scene that freezes discs
/// and does not know them yet. `has_others_alone`: its species have lost the frozen discs already,
/// because they were stored with the discs that move.
void set_frozen(SceneParameters& scene, std::vector<FrozenDisc> frozen,
                bool has_others_alone = false);

/// Whether a setting is the one that set_frozen adds.
bool is_of_frozen(std::string_view setting);

/// Checks the regions of `discs.freeze`.
void check_freezing(const SceneDraft& draft);

/// Makes the discs of `discs.frozen` obstacles, after all other checks.
void take_frozen(const SceneDraft& draft);

} // namespace carrom
