// SPDX-License-Identifier: BSD-3-Clause
// The keys a scene may have, and the one a misspelt key was most likely meant to be.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace carrom {

enum class ValueKind {
    number,
    integer,
    text,
    words,
    flag,
    rows,
    fixed_discs,
    segments,
    streams,
    species
};

/// What the key "table.name" holds, or nothing where there is no such key.
std::optional<ValueKind> kind_of_key(std::string_view key);

/// Whether `key` names a table that keys may stand in: "box", "output.checkpoint".
bool is_table(std::string_view key);

/// Whether `key` has a say in what discs the generator of that name makes; a key without one is an
/// error.
bool has_meaning_for(std::string_view generator, std::string_view key);

/// "no such key; did you mean 'time.steps'?" with the nearest known key by edit distance, or the
/// keys there are where none is near, or why this version has none (`effects` and most of
/// `output`).
std::string unknown_key_text(std::string_view key);

/// "; did you mean \"all\"?" with the nearest of a few names, each end of it in `quote`; empty
/// where none is near: one letter wrong, or up to a third of them.
std::string guess(std::string_view name, std::span<const std::string_view> names, char quote);

/// Insertions, deletions and replacements that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

} // namespace carrom
