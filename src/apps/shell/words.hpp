// SPDX-License-Identifier: BSD-3-Clause
// Words and lines that several commands print.
#pragma once

#include <string>

#include "scene/scene_parameters.hpp"

namespace carrom {

/// The word of `time.method`.
const char* name_of(Method method);

/// A label of at most 12 characters and a text. The text may come from a file, so
/// control characters are escaped.
std::string labelled_line(const char* label, const std::string& text);

} // namespace carrom
