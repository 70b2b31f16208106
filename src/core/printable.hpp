// SPDX-License-Identifier: BSD-3-Clause
// Makes text from files safe to print. It may contain any bytes, and a terminal takes some of them
// as commands.
#pragma once

#include <string>
#include <string_view>

namespace carrom {

/// Replaces each control character by an escape, such as \x1b. Ends of lines are kept
/// if `keeps_lines`. Other bytes stay as they are, UTF-8 or not.
std::string printable(std::string_view text, bool keeps_lines = false);

} // namespace carrom
