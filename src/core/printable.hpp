// SPDX-License-Identifier: BSD-3-Clause
// Names and texts of files hold any bytes; a terminal obeys some of them.
#pragma once

#include <string>
#include <string_view>

namespace carrom {

/// Replaces each control character by an escape, such as \x1b. Ends of lines are kept
/// if `keeps_lines`. Other bytes stay as they are, UTF-8 or not.
std::string printable(std::string_view text, bool keeps_lines = false);

} // namespace carrom
