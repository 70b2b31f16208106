// SPDX-License-Identifier: BSD-3-Clause
// The reference of keys, docs/reference/keys.md and conflicts.md, written from the declarations.
#pragma once

#include <string>

namespace carrom {

/// All keys by table, as Markdown.
std::string key_page();

/// All features that do not go together, as Markdown.
std::string conflicts_page();

} // namespace carrom
