// SPDX-License-Identifier: BSD-3-Clause
// A small file that is either written whole or not at all: beside its place first, then renamed.
//
// Whether it can be written is found out before the run, not after a week.
#pragma once

#include <string>

#include "core/write_problem.hpp"

namespace carrom {

/// What would keep `write_whole_file` from writing to `path`, if anything is known to. Leaves
/// nothing behind.
WriteProblem write_problem_of_file(const std::string& path);

/// Replaces `path` by a file with this text. Returns what went wrong, empty if nothing did.
std::string write_whole_file(const std::string& path, const std::string& text);

/// Adds text at the end of a file, all of it or nothing; where it `is_new` there must be no file
/// yet. Returns 0 or an errno.
int append_whole(const std::string& path, const std::string& text, bool is_new = false);

} // namespace carrom
