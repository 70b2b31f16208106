// SPDX-License-Identifier: BSD-3-Clause
// The folders of a path that do not exist yet, on one rank. Whatever makes them and fails before it
// writes anything leaves no empty folders behind.
#pragma once

#include <string>
#include <vector>

namespace carrom {

class MadeFolders {
public:
    MadeFolders() = default;
    /// Before the folder `path` and those above it are made.
    explicit MadeFolders(const std::string& path);
    /// Removes those that are empty.
    ~MadeFolders();
    MadeFolders(MadeFolders&& other) noexcept;
    MadeFolders& operator=(MadeFolders&&) = delete;

private:
    std::vector<std::string> paths_; ///< the innermost one first
};

} // namespace carrom
