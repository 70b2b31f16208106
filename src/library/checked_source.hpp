// SPDX-License-Identifier: BSD-3-Clause
// Turns a public Scene, which consists of keys and text, into a checked scene and its first discs.
#pragma once

#include <string>
#include <vector>

#include <carrom/scene.hpp>

#include "engine/tuning.hpp"
#include "parallel/communicator.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Runs `read`. If it throws InputError, the problems name keys as the program has set them, and
/// not as command-line options.
template <class Read> auto with_named_keys(const Read& read) {
    try {
        return read();
    } catch (const InputError& error) {
        std::vector<Problem> problems = error.problems();
        for (const std::string option : {"--set ", "--restart "})
            for (Problem& problem : problems)
                if (problem.place.starts_with(option)) problem.place.erase(0, option.size());
        throw InputError(std::move(problems));
    }
}

SceneFacts facts_of(const SceneParameters& scene);

struct FirstState {
    SceneParameters scene;
    std::vector<InputDisc> discs;
};

/// The checked scene and this rank's share of its discs. Throws InputError on every rank with all
/// problems. **Collective.**
FirstState first_state(const Scene& scene, const Communicator& ranks, const Tuning& tuning);

} // namespace carrom
