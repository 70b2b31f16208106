// SPDX-License-Identifier: BSD-3-Clause
// The checkpoints of a run in their folder: names, the newest one, and those to remove.
//
// These are calls of one rank, on a folder that all ranks see.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/write_problem.hpp"

namespace carrom {

/// The path, such as "folder/checkpoint-000000001000.h5".
std::string checkpoint_path(const std::string& folder, std::int64_t step);

struct FoundFile {
    std::string path;
    std::int64_t step = 0;
};

/// Files named like checkpoints, the latest step first; none if the folder does not exist.
/// Throws FileError if the folder cannot be listed, because then its contents are unknown.
std::vector<FoundFile> find_checkpoints(const std::string& folder);

/// Whether the path could come from `checkpoint_path`.
bool is_named_as_checkpoint(const std::string& path);

/// Makes the folder if there is none. Returns the problem if files cannot be written there.
WriteProblem write_problem_of_folder(const std::string& folder);

} // namespace carrom
