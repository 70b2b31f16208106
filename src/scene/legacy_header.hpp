// SPDX-License-Identifier: BSD-3-Clause
// The legacy text format: N, L, r, S and `print` or `perf`, one per line, then nothing or N lines
// "id x y vx vy". Before such lines `print` or `perf` may be left out.
#pragma once

#include <string>
#include <string_view>

#include "scene/settings.hpp"

namespace carrom {

inline constexpr int legacy_header_lines = 5; ///< number of lines, if none is blank

/// Adds the settings in the header `text`. `discs_follow`: lines of discs follow in the input.
void add_legacy_header(Settings& settings, Problems& problems, std::string_view text,
                       const std::string& name, bool discs_follow);

} // namespace carrom
