// SPDX-License-Identifier: BSD-3-Clause
// Lets one run at a time write to a place. Two would remove each other's files and
// write into the same ones.
//
// The lock is flock's, on a small file of its own (HDF5 locks its files itself). The
// kernel releases it with the process. Lustre shares it between nodes if it is mounted
// with `flock`. On a file system without locks there is no protection.
#pragma once

#include <memory>
#include <string>

#include "io/files.hpp"

namespace carrom {

class WriteLock {
public:
    /// Takes the lock of `path`, on one rank. If another process has it and keeps it for two
    /// seconds, `holder` names the process; else it is empty, also if there are no locks.
    explicit WriteLock(std::string path);
    /// Releases the lock, and removes the file unless another one has its name.
    ~WriteLock();
    WriteLock(WriteLock&& other) noexcept;
    WriteLock& operator=(WriteLock&&) = delete;

    const std::string& holder() const { return holder_; }
    /// Why there can be no lock, for example because the name is a symbolic link; else empty.
    const std::string& problem() const { return problem_; }
    /// Whether the lock is held and its name leads elsewhere: its folder, or it, was moved,
    /// removed or replaced.
    bool is_lost() const;

private:
    bool try_once();

    std::string path_, holder_, problem_;
    int file_ = -1;                      ///< open while the lock is held
    std::unique_ptr<HeldFolder> folder_; ///< where the lock lies, while it is held
};

} // namespace carrom
