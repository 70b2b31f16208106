// SPDX-License-Identifier: BSD-3-Clause
// Standard output as a place for data: large writes, and a failure that is remembered instead of ending the process.
//
// Works on the file descriptor: a closed pipe or a full disk is then an errno at a known place. The caller tells the
// other ranks of a failure.
#pragma once

#include <cstddef>
#include <string>

#include <fmt/format.h>

namespace carrom {

class StandardOutput {
public:
    /// From here on a closed pipe is an error of `write`, not the end of the process.
    StandardOutput();

    /// Text to append to; full buffers are written by `flush_if_full`.
    fmt::memory_buffer& buffer() { return buffer_; }

    void flush_if_full();
    void flush();

    /// What went wrong first, empty while all is well. After a failure nothing more is written.
    const std::string& failure() const { return failure_; }

private:
    static constexpr std::size_t full = std::size_t{1} << 20;

    fmt::memory_buffer buffer_;
    std::string failure_;
};

} // namespace carrom
