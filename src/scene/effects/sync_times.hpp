// SPDX-License-Identifier: BSD-3-Clause
// Times of syncs for effects that by default act about once a step.
#pragma once

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

/// Makes the time between syncs at most a step, unless the scene sets it.
inline void sync_in_each_step(const SceneDraft& draft) {
    if (!draft.settings.has("time.sync_every"))
        draft.scene.sync_every = std::min(draft.scene.sync_every, draft.scene.micro_steps);
}

/// Warns if a run ends before its first sync. The message begins with `words`, such as "the wind
/// never blows: it would".
inline void warn_of_no_sync(const SceneDraft& draft, std::string_view words) {
    SceneParameters& scene = draft.scene;
    const double interval = steps_between_syncs(scene);
    if (scene.steps == 0 || interval <= static_cast<double>(scene.steps)) return;
    scene.warnings.push_back(fmt::format(
        "{} every {:g} steps (time.sync_every), and the run has {}", words, interval, scene.steps));
}

} // namespace carrom
