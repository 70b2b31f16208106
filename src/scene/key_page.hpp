// SPDX-License-Identifier: BSD-3-Clause
// The reference of keys, docs/reference/keys.md and conflicts.md, written from their declarations.
#pragma once

#include <string>

namespace carrom {

/// All keys by table. Markdown.
std::string key_page();

/// What does not go together. Markdown.
std::string conflicts_page();

} // namespace carrom
