// SPDX-License-Identifier: BSD-3-Clause
// A small file that is written as a whole or not at all: under another name, then renamed.
//
// Whether it can be written is checked before the run, not after a week.
#pragma once

#include <cstdint>
#include <string>

#include "core/write_problem.hpp"

namespace carrom {

/// The problem that would keep `write_whole_file` from writing to `path`, as far as it
/// can be known. Leaves nothing behind.
WriteProblem write_problem_of_file(const std::string& path);

/// Replaces `path` by a file with this text. Returns the problem, or empty.
std::string write_whole_file(const std::string& path, const std::string& text);

/// Appends text to a file, all of it or nothing. If it `is_new` the file must not
/// exist yet. Returns 0 or an errno.
int append_whole(const std::string& path, const std::string& text, bool is_new = false);

/// Whether a file of this size in bytes is there.
bool has_size(const std::string& path, std::uint64_t size);

} // namespace carrom
