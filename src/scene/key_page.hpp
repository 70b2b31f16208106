// SPDX-License-Identifier: BSD-3-Clause
// Writes the reference of keys, docs/reference/keys.md and conflicts.md, from the declarations.
#pragma once

#include <string>

namespace carrom {

/// The text of keys.md: all keys by table, as Markdown.
std::string key_page();

/// The text of conflicts.md: all features that cannot be combined, as Markdown.
std::string conflicts_page();

} // namespace carrom
