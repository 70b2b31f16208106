// SPDX-License-Identifier: BSD-3-Clause
// The folders of a path that do not exist yet, on one rank. So code that makes these folders, and
// fails before it writes anything, leaves no empty folders behind.
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
