// SPDX-License-Identifier: BSD-3-Clause
// From the text of a scene to the checked scene, with the discs and columns that its files give.
//
// Rank 0 reads the files; the others get its bytes, and come to the same scene or the same
// problems.
#pragma once

#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "parallel/communicator.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene.hpp"

namespace carrom {

inline void append(std::vector<Problem>& problems, const std::vector<Problem>& more) {
    problems.insert(problems.end(), more.begin(), more.end());
}

struct SceneSource {
    SceneText text; ///< the same on all ranks
    /// On rank 0: the input behind the text, at the first line of discs if there are any.
    std::unique_ptr<std::istream> stream{};
};

/// Reads the scene with the settings on top. Where it names `discs.from`, those discs become the
/// lines that follow its text. Where its file of discs has more columns, they are read too; they
/// are not whole where lines are wrong, see `disc_line_problems_of`. Appends to `problems` what all
/// ranks find, to `of_root` what rank 0 finds. **Collective.**
Scene read_with_files(SceneSource& source, std::vector<std::string> settings,
                      std::vector<Problem>& problems, std::vector<Problem>& of_root,
                      const Communicator& ranks);

/// The same; throws InputError on every rank with all problems. **Collective.**
Scene read_with_files(SceneSource& source, const std::vector<std::string>& settings,
                      const Communicator& ranks);

/// Whether the columns of the file of discs could not be read.
bool are_columns_wrong(const SceneSource& source);

/// What is wrong with the lines of discs of a scene that cannot be run, so that all is printed at
/// once. They follow a header in `stream`, or have a file of their own. One rank calls this.
std::vector<Problem> disc_line_problems_of(const Scene& scene, std::istream* stream);

} // namespace carrom
