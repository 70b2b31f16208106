// SPDX-License-Identifier: BSD-3-Clause
// The folder of a run: all its files (docs/reference/formats.md), and a copy of its scene, from
// which it can be continued.
//
// A lock ensures that only one run writes there at a time. A run from step 0 needs a folder without
// a run, or the option --overwrite. Only rank 0 calls these functions.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_parameters.hpp"

namespace carrom {

/// The name of the lock file in the folder of a run that is writing there.
inline constexpr const char* lock_of_run = ".carrom.lock";

/// Whether runs use a subfolder of this name.
bool is_subfolder_of_run(std::string_view name);
/// The name of the folder of replica `k`.
std::string name_of_replica(std::int64_t k);

/// The paths of the files that a run may have directly in the folder.
std::vector<std::string> files_of_run(const std::string& folder);
std::string report_of_run(const std::string& folder);
std::string checkpoints_of_run(const std::string& folder);

/// The name of a file or subfolder that a run has written in the folder; empty if there is none.
std::string trace_of_run(const std::string& folder);

/// The name of a file in the folder with data of steps after 0; empty if there is none. A file that
/// cannot be read counts as such a file.
std::string recorded_beyond_start(const std::string& folder);

/// Describes a file of another program that a table of the scene would replace; empty if there is
/// none.
std::string problem_with_tables(const SceneParameters& scene);

/// Describes why a copy of the scene could not be read; empty if it can be read.
std::string problem_with_copy(const SceneParameters& scene);

/// The path of the copy of the scene; empty if there is none.
std::string scene_copy_of(const std::string& folder);

/// The overrides that a copy of a scene lists before the scene's text; empty for other files.
std::vector<std::string> overrides_of_copy(const std::string& path);

/// Describes the difference between the folder's run and the scene; empty if there is
/// none. A folder without a readable scene is a difference, too.
std::string difference_from_run(const std::string& folder, const SceneParameters& scene);

/// Removes the files of a run, the copy of its scene first. Leaves all other files,
/// and all files behind symbolic links.
void remove_run(const std::string& folder);

/// Describes why `remove_run` cannot remove all files; empty if it can.
std::string problem_of_removal(const std::string& folder);

/// Creates the run's folders and writes the copy of its scene. Throws FileError.
void prepare_folder(const SceneParameters& scene);

} // namespace carrom
