// SPDX-License-Identifier: BSD-3-Clause
// Output of a run's data to standard output or a file. It writes in large pieces, and a failure is
// stored instead of ending the process.
//
// It uses a file descriptor, so a closed pipe or a full disk gives an errno at a known
// call. The caller reports a failure to the other ranks.
#pragma once

#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "core/write_problem.hpp"

namespace carrom {

class DataOutput {
public:
    /// Opens the file and empties it; uses standard output if `path` is empty. From then on writing
    /// to a closed pipe is an error of `flush`, and does not end the process.
    explicit DataOutput(const std::string& path);
    ~DataOutput();
    DataOutput(const DataOutput&) = delete;
    DataOutput& operator=(const DataOutput&) = delete;

    /// The buffer to which callers append text; `flush_if_full` writes it once it is full.
    fmt::memory_buffer& buffer() { return buffer_; }

    void flush_if_full();
    void flush();

    /// Closes the file. Nothing may be written after this. Some file systems report a full disk
    /// only when a file is closed. It is also a failure if the file has been removed.
    void close();

    /// The text of the first failure, or empty. After a failure nothing more is written.
    const std::string& failure() const { return failure_; }

private:
    static constexpr std::size_t full = std::size_t{1} << 20;

    void fail_with(int error);

    std::string name_;
    int file_;
    bool is_ours_, is_named_file_ = false;
    fmt::memory_buffer buffer_;
    std::string failure_;
};

/// The problem that would keep a DataOutput from opening `path`, as far as it can be found without
/// changing the file.
WriteProblem write_problem_of_stream(const std::string& path);

} // namespace carrom
