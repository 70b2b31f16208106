// SPDX-License-Identifier: BSD-3-Clause
// Lists the folders of a path that do not exist yet. When the list is destroyed, it removes those
// of them that exist by then and are empty, so that a failed run leaves no empty folders. Used on
// one rank.
#pragma once

#include <string>
#include <vector>

namespace carrom {

class MadeFolders {
public:
    MadeFolders() = default;
    /// Call it before the folder `path` and the folders above it are made.
    explicit MadeFolders(const std::string& path);
    /// Removes the new folders that are empty.
    ~MadeFolders();
    MadeFolders(MadeFolders&& other) noexcept;
    MadeFolders& operator=(MadeFolders&&) = delete;

private:
    std::vector<std::string> paths_; ///< paths of the new folders, innermost first
};

} // namespace carrom
