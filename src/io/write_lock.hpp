// SPDX-License-Identifier: BSD-3-Clause
// Allows only one run at a time to write to a path. Otherwise two runs would remove each other's
// files or write to the same file.
//
// The lock is taken by flock on a small separate file, because runs replace their other files. The
// kernel releases it when the process ends. Lustre shares it between nodes if it is mounted with
// `flock`. On a file system without locks there is no protection.
#pragma once

#include <memory>
#include <string>

#include "io/files.hpp"
#include "io/made_folders.hpp"

namespace carrom {

class WriteLock {
public:
    /// Takes the lock of `path`, on one rank. If another process keeps it for two seconds, `holder`
    /// names that process; otherwise it is empty, also on a file system without locks. `made` are
    /// the folders that were made for the lock.
    explicit WriteLock(std::string path, MadeFolders made = {});
    /// Releases the lock, and removes the file unless the name now belongs to another file. Then
    /// removes the folders that were made, if they are empty.
    ~WriteLock();
    WriteLock(WriteLock&& other) noexcept;
    WriteLock& operator=(WriteLock&&) = delete;

    const std::string& holder() const { return holder_; }
    /// The reason why there can be no lock, for example because the name is a symbolic link;
    /// otherwise empty.
    const std::string& problem() const { return problem_; }
    /// Whether the lock is held but its name leads elsewhere, because the file or its folder was
    /// moved, removed or replaced.
    bool is_lost() const;

private:
    bool try_once();

    MadeFolders made_; // declared first, so that it is destroyed last
    std::string path_, holder_, problem_;
    int file_ = -1;                      ///< open while the lock is held
    std::unique_ptr<HeldFolder> folder_; ///< the folder of the lock, while it is held
};

} // namespace carrom
