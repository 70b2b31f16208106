// SPDX-License-Identifier: BSD-3-Clause
// The folder of a run: all that it writes (docs/reference/formats.md), and a copy of its scene to
// go on with.
//
// One run writes there at a time: one lock. A run that begins anew needs a folder without a run.
// All calls are rank 0's.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace carrom {

/// Files that stand in the folder itself.
std::vector<std::string> files_of_run(const std::string& folder);
std::string report_of_run(const std::string& folder);
std::string checkpoints_of_run(const std::string& folder);

/// The name of something that a run has written there; empty if there is nothing.
std::string trace_of_run(const std::string& folder);

/// The name of something that a run has recorded there after step 0; empty if there is nothing.
/// What cannot be read counts.
std::string recorded_beyond_start(const std::string& folder);

/// The copy of the scene, if there is one; else empty.
std::string scene_copy_of(const std::string& folder);

/// What was set on top of the text of a copy; nothing for other files.
std::vector<std::string> overrides_of_copy(const std::string& path);

/// How the run of the folder differs from the scene; empty if it does not. Words, too, where the
/// folder has no scene that can be read.
std::string difference_from_run(const std::string& folder, const Scene& scene);

/// Removes what a run has written, the copy of its scene first. Leaves all other files, and all
/// behind symbolic links.
void remove_run(const std::string& folder);

/// One of the run's inner folders that is a symbolic link; empty if none is.
std::string link_of_run(const std::string& folder);

/// Makes the folders and writes the copy of the scene. Throws FileError.
void prepare_folder(const Scene& scene);

} // namespace carrom
