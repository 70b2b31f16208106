// SPDX-License-Identifier: BSD-3-Clause
// Turns the text of a scene into the checked scene, with the discs and columns from its files.
//
// Rank 0 reads the scene and broadcasts its text, so all ranks find the same scene or the same
// problems. Each other rank reads its own share of the discs of `discs.from`.
#pragma once

#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "parallel/communicator.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

inline void append(std::vector<Problem>& problems, const std::vector<Problem>& more) {
    problems.insert(problems.end(), more.begin(), more.end());
}

struct SceneSource {
    SceneText text; ///< equal on all ranks
    /// On rank 0: the rest of the input after the text, from the first line of discs, or the lines
    /// of `discs.from`. On other ranks: the lines of their shares of `discs.from`, or null.
    std::unique_ptr<std::istream> stream{};
};

/// Reads the scene; `settings` override its keys. Discs of `discs.from` are added as lines after
/// its text. The columns and the number of discs in a file of discs are added as settings. The
/// columns of radii, masses and so on are read, too; they are incomplete if lines are wrong, see
/// `disc_line_problems_of`. Appends problems found by all ranks to `problems`, and those found by
/// rank 0 to `of_root`. **Collective.**
SceneParameters read_with_files(SceneSource& source, std::vector<std::string> settings,
                                std::vector<Problem>& problems, std::vector<Problem>& of_root,
                                const Communicator& ranks);

/// Reads the scene; throws InputError on every rank with all problems. **Collective.**
SceneParameters read_with_files(SceneSource& source, const std::vector<std::string>& settings,
                                const Communicator& ranks);

/// Whether the columns of the file of discs could not be read.
bool are_columns_wrong(const SceneSource& source);

/// Checks the lines of discs of a scene that has other problems, so that all are printed together.
/// The lines are the rest of `stream`, or a file of their own. Called on one rank.
std::vector<Problem> disc_line_problems_of(const SceneParameters& scene, std::istream* stream);

} // namespace carrom
