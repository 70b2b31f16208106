// SPDX-License-Identifier: BSD-3-Clause
// Which files belong to a run or to replicas, and what an existing file holds. Outputs that a user
// names are checked against both (destinations.hpp), so that no run loses a file to another output.
//
// A run owns by folder: everything below its subfolders, whatever its name, and its own files
// beside them. Links are followed, because an output would be written behind them.
#pragma once

#include <string>

namespace carrom {

/// The owner of a path, as in "a file of the run in FOLDER"; empty if there is none. `own_folder`
/// is that of the run at hand, which may not have begun; it may be empty.
std::string owner_of_file(const std::string& path, const std::string& own_folder);

/// The owner of the folder that a path lies in, if only the owner may make files there: a folder
/// of a run below that of checkpoints, recordings or tables.
std::string owner_of_folder(const std::string& path);

/// Whether a run in `folder` has the path in one of its subfolders, whose files it may remove.
bool is_in_subfolder_of_run(const std::string& path, const std::string& folder);

enum class FileContent { nothing, hdf5, report, scene, table, other };

/// What an existing plain file holds: scenes and discs by the ends of their names, other files by
/// their first bytes. Files that are missing, empty or unreadable hold nothing.
FileContent content_of(const std::string& path);

} // namespace carrom
