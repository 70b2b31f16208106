// SPDX-License-Identifier: BSD-3-Clause
// Makes text from files safe to print. Such text may contain any bytes, and a terminal executes
// some of them as commands.
#pragma once

#include <string>
#include <string_view>

namespace carrom {

/// Replaces each control character by an escape such as \x1b, except line breaks if `keeps_lines`.
/// All other bytes stay unchanged, even if they are not valid UTF-8.
std::string printable(std::string_view text, bool keeps_lines = false);

} // namespace carrom
