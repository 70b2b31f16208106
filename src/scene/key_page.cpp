// SPDX-License-Identifier: BSD-3-Clause
#include "scene/key_page.hpp"

#include <cmath>

#include <fmt/format.h>

#include "scene/checked_value.hpp"
#include "scene/quantity.hpp"
#include "scene/toml_text.hpp"

namespace carrom {

namespace {

constexpr std::string_view opening = R"(# Keys of a scene

`carrom keys` writes this page from the declarations that the program reads scenes with.

A scene is a TOML file. An unknown key is an error, and so is a key that has no meaning in the
scene. `--set key=value` sets any key on the command line and replaces what excludes it in the file.
Where it sets a word, as a `kind`, it drops the keys of that table that have no meaning beside it.
Lengths are in any unit, times in steps, masses in units of the disc's mass. A unit of 1 is a pure
number. [What goes with what](conflicts.md) lists what excludes each other.
)";

constexpr std::string_view opening_of_conflicts = R"(# What goes with what

`carrom keys --conflicts` writes this page from the checks that the program makes. Effects and
methods go together, but for these. Each of them is an error that names the key.

)";

std::string code(std::string_view text) { return fmt::format("`{}`", text); }

std::string joined(const std::vector<std::string_view>& names, std::string_view before) {
    std::string list;
    for (const std::string_view name : names) list += (list.empty() ? "" : ", ") + code(name);
    return list.empty() ? "" : fmt::format(" {} {}.", before, list);
}

std::string form_of(const Field& field) {
    if (field.is_flag()) return "true or false";
    if (!field.words.empty()) return words_text(field.words);
    return field.form.empty() ? "..." : std::string(field.form);
}

std::string fallback_of(const Field& field) {
    if (std::isnan(*field.fallback)) return " (if any)";
    if (field.words.empty()) return fmt::format(" ({} unless given)", *field.fallback);
    const auto word = field.words[static_cast<std::size_t>(*field.fallback)];
    return field.is_flag() ? fmt::format(" ({} unless given)", word)
                           : fmt::format(" (\"{}\" unless given)", word);
}

std::string type_text(const Key& key) {
    switch (key.kind) {
    case Kind::text: return "text, not empty";
    case Kind::choice: return words_text(key.words);
    case Kind::words: return "list of " + words_text(key.words);
    case Kind::tables: {
        std::string list;
        for (const Field& field : key.fields) {
            list += list.empty() ? "" : ", ";
            list += fmt::format("{} = {}", field.name, form_of(field));
            if (field.fallback) list += fallback_of(field);
        }
        return "tables of " + list;
    }
    case Kind::rows: return (key.is_one_row ? "" : "rows ") + std::string(key.fields[0].form);
    default: return kind_text(key);
    }
}

std::string default_text(const Key& key, const SceneParameters& plain) {
    if (!key.fallback.empty()) return std::string(key.fallback);
    if (key.is_required) return "required";
    return code(toml_text(key, key.get(plain)));
}

std::string row_of(const Key& key, const SceneParameters& plain) {
    std::string condition;
    if (key.need) condition += fmt::format(" No meaning {}.", key.need->text);
    condition += joined(key.or_from, "Not required with") + joined(key.instead_of, "Not with");
    return fmt::format("| {} | {} | {} | {} | {} |{} |\n", code(key.name), type_text(key),
                       key.unit.empty() ? "-" : key.unit, default_text(key, plain), key.help,
                       condition);
}

} // namespace

std::string conflicts_page() {
    std::string text{opening_of_conflicts};
    text += "| | not together with | because |\n|---|---|---|\n";
    for (const Rule& rule : rules())
        text += fmt::format("| {} | {} | {} |\n", rule.one, rule.other, rule.why);
    return text;
}

std::string key_page() {
    SceneParameters plain;
    for (const Table& table : tables()) table.create(plain);
    std::string text{opening};
    for (const Table& table : tables()) {
        std::string rows;
        for (const Key& key : keys())
            if (key.table() == table.name) rows += row_of(key, plain);
        if (rows.empty() || table.is_like_another) continue;
        text += fmt::format("\n## [{}]\n\n{}\n\n| key | type and range | unit | default | meaning "
                            "| condition |\n|---|---|---|---|---|---|\n{}",
                            table.name, table.help, rows);
    }
    text += "\n## Quantities\n\nWords of `output.measurements.quantities`.\n\n| quantity | what it "
            "is | "
            "settings |\n|---|---|---|\n";
    for (const Quantity& quantity : declared_quantities()) {
        std::string settings;
        for (const Key& key : quantity.keys)
            settings += (settings.empty() ? "" : ", ") +
                        code(key.name.substr(key.name.rfind('.') + 1));
        text += fmt::format("| {} | {} | {} |\n", code(quantity.name), quantity.help, settings);
    }
    return text;
}

} // namespace carrom
