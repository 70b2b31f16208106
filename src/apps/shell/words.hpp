// SPDX-License-Identifier: BSD-3-Clause
// Words and lines that several commands print.
#pragma once

#include <string>

#include "scene/scene_parameters.hpp"

namespace carrom {

/// The value of the key `time.method`: the name of the method.
const char* name_of(Method method);

/// A line with a label of at most 12 characters and a text. Control characters in the text are
/// escaped, because it may come from a file.
std::string labelled_line(const char* label, const std::string& text);

} // namespace carrom
