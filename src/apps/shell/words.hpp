// SPDX-License-Identifier: BSD-3-Clause
// Words and lines that several commands print.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace carrom {

/// As `time.method` has it.
const char* name_of(Method method);

/// A label of at most 12 characters and a text, which may come from a file: control characters are
/// escaped.
std::string labelled_line(const char* label, const std::string& text);

} // namespace carrom
