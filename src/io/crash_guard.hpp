// SPDX-License-Identifier: BSD-3-Clause
// HDF5 1.10 does not survive all metadata: a wrong size of a heap, say, makes it read from nowhere.
// While it reads what may be damaged, such a signal ends all ranks with code 2 and the file's name,
// and not as a bug of this program would.
//
// Nothing is gone on with after the signal: a message, the end of all ranks, and that is all.
// (Reading in a process of its own would allow more, but forking is not safe under every MPI
// library.)
#pragma once

#include <array>
#include <csignal>
#include <cstddef>
#include <string>

namespace carrom {

class CrashGuard {
public:
    /// `path` must outlive this. Guards may stand inside one another; of one thread.
    explicit CrashGuard(const std::string& path);
    ~CrashGuard();
    CrashGuard(const CrashGuard&) = delete;
    CrashGuard& operator=(const CrashGuard&) = delete;

private:
    static constexpr std::array signals = {SIGSEGV, SIGBUS, SIGFPE, SIGABRT};

    const char* outer_path_;
    std::array<struct sigaction, signals.size()> outer_actions_{};
};

} // namespace carrom
