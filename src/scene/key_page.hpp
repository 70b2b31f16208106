// SPDX-License-Identifier: BSD-3-Clause
// The reference of keys, docs/reference/keys.md, written from their declarations.
#pragma once

#include <string>

namespace carrom {

/// All keys by table, then what does not go together. Markdown.
std::string key_page();

/// The table of what does not go together alone.
std::string rules_table();

} // namespace carrom
