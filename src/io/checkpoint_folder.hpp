// SPDX-License-Identifier: BSD-3-Clause
// The checkpoints of a run in their folder: how they are named, which is the newest, which ones go.
//
// These are calls of one rank, on a folder that all ranks see.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/write_problem.hpp"

namespace carrom {

/// "folder/checkpoint-000000001000.h5"
std::string checkpoint_path(const std::string& folder, std::int64_t step);

struct FoundFile {
    std::string path;
    std::int64_t step = 0;
};

/// Files named like checkpoints, those of the latest step first. A folder that does not exist has
/// none. Throws FileError if the folder cannot be listed, because then nobody knows what it has.
std::vector<FoundFile> find_checkpoints(const std::string& folder);

/// Whether the file's name is one that `checkpoint_path` gives.
bool is_named_as_checkpoint(const std::string& path);

/// Makes the folder where there is none. Returns what keeps files from being written there, if
/// anything does.
WriteProblem write_problem_of_folder(const std::string& folder);

} // namespace carrom
