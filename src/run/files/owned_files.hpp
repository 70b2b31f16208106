// SPDX-License-Identifier: BSD-3-Clause
// Which files belong to a run or to replicas, and the kind of content of an existing file. Outputs
// that a user names are checked against both (destinations.hpp), so that no run loses a file to
// another output.
//
// A run owns everything below its subfolders, and its own files beside them. Links are followed,
// because an output would be written to their target.
#pragma once

#include <string>

namespace carrom {

/// The owner of a path, as in "a file of the run in FOLDER"; empty if there is none. `own_folder`
/// is the folder of the present run, which may not have begun yet; empty if it has none.
std::string owner_of_file(const std::string& path, const std::string& own_folder);

/// The owner of a folder, or of the folder around it, if only the owner may create files there: a
/// run owns its folders for checkpoints, recordings and tables. Empty if there is none.
std::string owner_of_folder(const std::string& path);

/// Whether the path is in a subfolder of the run in `folder`. The run may remove files there.
bool is_in_subfolder_of_run(const std::string& path, const std::string& folder);

enum class FileContent { nothing, hdf5, report, scene, table, other };

/// The kind of content of an existing plain file: scenes and discs by the suffixes of their names,
/// other files by their first bytes. Files that are missing, empty or unreadable have no content.
FileContent content_of(const std::string& path);

} // namespace carrom
