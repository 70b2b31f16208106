// SPDX-License-Identifier: BSD-3-Clause
// A place that one run at a time may write to: two would remove each other's files and write into
// one.
//
// The lock is flock's, on a small file of its own (HDF5 locks its files itself). The kernel
// releases it with the process. Lustre carries it between nodes where it is mounted with `flock`.
// Where a file system has no locks there is no protection.
#pragma once

#include <string>

namespace carrom {

class WriteLock {
public:
    /// Takes the lock that `path` stands for, of one rank. If another process has it, and keeps it
    /// for two seconds, `holder` says which; empty else, also where there are no locks.
    explicit WriteLock(std::string path);
    /// Gives it back, and removes the file.
    ~WriteLock();
    WriteLock(WriteLock&& other) noexcept;
    WriteLock& operator=(WriteLock&&) = delete;

    const std::string& holder() const { return holder_; }
    /// Why there can be no lock, as where the name is a symbolic link; empty else.
    const std::string& problem() const { return problem_; }

private:
    bool try_once();

    std::string path_, holder_, problem_;
    int file_ = -1; ///< open where the lock is held
};

} // namespace carrom
