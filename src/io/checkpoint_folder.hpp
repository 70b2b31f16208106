// SPDX-License-Identifier: BSD-3-Clause
// The checkpoints of a run in their folder: their names, and a list of them, newest first.
//
// Only one rank calls these functions. All ranks must be able to access the folder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/write_problem.hpp"

namespace carrom {

/// The path of a step's checkpoint, such as "folder/checkpoint-000000001000.h5".
std::string checkpoint_path(const std::string& folder, std::int64_t step);

struct FoundFile {
    std::string path;
    std::int64_t step = 0;
};

/// Files that are named like checkpoints, the latest step first; none if the folder does not exist.
/// Throws FileError if the folder cannot be listed, because then its contents are unknown.
std::vector<FoundFile> find_checkpoints(const std::string& folder);

/// Whether the path has the form that `checkpoint_path` returns.
bool is_named_as_checkpoint(const std::string& path);

/// Makes the folder if it does not exist. Returns the problem if it cannot be made or no file can
/// be made in it.
WriteProblem write_problem_of_folder(const std::string& folder);

} // namespace carrom
