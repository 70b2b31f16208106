// SPDX-License-Identifier: BSD-3-Clause
#include "io/made_folders.hpp"

#include <filesystem>
#include <utility>

#include <unistd.h>

namespace carrom {

MadeFolders::MadeFolders(const std::string& path) {
    std::error_code error;
    std::filesystem::path place = std::filesystem::absolute(path, error).lexically_normal();
    if (!place.has_filename()) place = place.parent_path(); // drops a slash at the end
    for (; place.has_relative_path(); place = place.parent_path()) {
        if (error || std::filesystem::exists(place, error)) return;
        paths_.push_back(place.string());
    }
}

MadeFolders::~MadeFolders() {
    for (const std::string& path : paths_)
        if (::rmdir(path.c_str()) != 0) return; // a folder that is not empty stays
}

MadeFolders::MadeFolders(MadeFolders&& other) noexcept : paths_(std::exchange(other.paths_, {})) {}

} // namespace carrom
