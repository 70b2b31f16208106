// SPDX-License-Identifier: BSD-3-Clause
// Writes a small file as a whole or not at all: it gets a temporary name, and is then renamed.
//
// Whether it can be written is tested before the run, because after a long run it is too late.
#pragma once

#include <cstdint>
#include <string>

#include "core/write_problem.hpp"

namespace carrom {

/// The problem that would keep `write_whole_file` from writing to `path`, as far as it can be found
/// before the run. Leaves no file behind.
WriteProblem write_problem_of_file(const std::string& path);

/// Replaces `path` by a file with this text. Returns the problem, or an empty text.
std::string write_whole_file(const std::string& path, const std::string& text);

/// Appends the whole text to a file, or nothing. If `is_new`, the file must not exist yet. Returns
/// 0 or an errno.
int append_whole(const std::string& path, const std::string& text, bool is_new = false);

/// Whether there is a file of this size in bytes.
bool has_size(const std::string& path, std::uint64_t size);

} // namespace carrom
