// SPDX-License-Identifier: BSD-3-Clause
// The legacy text format has an entry per line: number of discs N, box edge L, radius r, number of
// steps S, `print` or `perf`. N lines "id x y vx vy" may follow; then the last entry is optional.
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
