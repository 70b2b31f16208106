// SPDX-License-Identifier: BSD-3-Clause
// How settings are looked at when a scene is checked: a value that is right, or nothing and one
// more problem.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scene/disc_columns.hpp"
#include "scene/keys.hpp"
#include "scene/number.hpp"
#include "scene/scene.hpp"
#include "scene/settings.hpp"

namespace carrom {

/// What every check needs: the settings, the problems so far, and the scene as far as it is known.
struct Check {
    Scene& scene;
    const Settings& settings;
    Problems& problems;
    const DiscColumns* columns = nullptr; ///< of the file of discs

    void refuse(const Setting& setting, std::string text) const {
        add_problem(problems, setting.place, std::move(text));
    }
    void refuse_missing(std::string_view key, std::string_view what) const {
        if (!settings.is_mentioned(key))
            add_problem(problems, {scene.name, 0}, fmt::format("'{}' is missing: {}", key, what));
    }
};

/// A finite number, or nothing after a problem (or where the key is absent).
inline std::optional<double> finite_number(const Check& check, std::string_view key) {
    const Setting* setting = check.settings.find(key);
    if (!setting) return std::nullopt;
    const double number = std::get<double>(setting->value);
    if (std::isfinite(number)) return number;
    check.refuse(*setting, fmt::format("'{}' must be a finite number, not {}", key, number));
    return std::nullopt;
}

/// A whole number from `low` to `high`; 1e5 counts as whole.
inline std::optional<std::int64_t> whole_number(const Check& check, std::string_view key,
                                                std::int64_t low, std::int64_t high) {
    const Setting* setting = check.settings.find(key);
    if (!setting) return std::nullopt;
    if (const auto* real = std::get_if<double>(&setting->value)) {
        if (!std::isfinite(*real) || *real != std::floor(*real)) {
            check.refuse(*setting, fmt::format("'{}' must be a whole number, not {}", key, *real));
        } else if (*real < static_cast<double>(low) || *real > static_cast<double>(high)) {
            check.refuse(*setting,
                         fmt::format("'{}' must be from {} to {}, not {}", key, low, high, *real));
        } else if (std::fabs(*real) < 0x1p63) {
            return static_cast<std::int64_t>(*real);
        }
        return std::nullopt;
    }
    const auto number = std::get<std::int64_t>(setting->value);
    if (number >= low && number <= high) return number;
    check.refuse(*setting,
                 fmt::format("'{}' must be from {} to {}, not {}", key, low, high, number));
    return std::nullopt;
}

template <class Choice, std::size_t n>
using Choices = std::array<std::pair<std::string_view, Choice>, n>;

/// One of a few words.
template <class Choice, std::size_t n>
std::optional<Choice> choice(const Check& check, std::string_view key,
                             const Choices<Choice, n>& choices) {
    const Setting* setting = check.settings.find(key);
    if (!setting) return std::nullopt;
    const std::string& word = std::get<std::string>(setting->value);
    std::array<std::string_view, n> names;
    std::string list;
    for (std::size_t i = 0; i < n; ++i) {
        if (choices[i].first == word) return choices[i].second;
        names[i] = choices[i].first;
        list += (i == 0 ? "" : i + 1 == n ? " or " : ", ") + fmt::format("\"{}\"", names[i]);
    }
    check.refuse(*setting, fmt::format("'{}' must be {}, not {}{}", key, list, quoted(word),
                                       guess(word, names, '"')));
    return std::nullopt;
}

/// True where the scene has a table of that name, or `--set` a key of it.
inline bool has_table(const Check& check, std::string_view table) {
    if (check.settings.is_mentioned(table)) return true;
    for (const Setting& setting : check.settings.all())
        if (setting.key.starts_with(table) && setting.key[table.size()] == '.') return true;
    return false;
}

/// The name of a file or folder that an output cannot do without; empty after a problem.
inline std::string destination(const Check& check, const std::string& key, std::string_view what) {
    check.refuse_missing(key, what);
    const Setting* setting = check.settings.find(key);
    if (!setting) return {};
    const std::string& path = std::get<std::string>(setting->value);
    if (path.empty()) check.refuse(*setting, fmt::format("'{}' is empty", key));
    return path;
}

} // namespace carrom
