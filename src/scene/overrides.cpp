// SPDX-License-Identifier: BSD-3-Clause
#include "scene/overrides.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "scene/keys.hpp"
#include "scene/number.hpp"
#include "scene/toml_settings.hpp"

namespace carrom {

namespace {

/// Pairs that say the same thing in two ways; the one from the command line wins.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> rivals = {
    {{"discs.radius", "discs.packing"},
     {"discs.file", "discs.list"},
     {"discs.columns", "discs.list"}}};

/// An accuracy asks for these to be chosen.
constexpr std::array<std::string_view, 5> chosen_by_accuracy = {
    "time.method", "time.micro_steps", "time.precision", "time.arithmetic", "time.contraction"};

void remove_rivals_of_accuracy(Settings& settings, const Settings& given) {
    for (const std::string_view key : chosen_by_accuracy) {
        if (given.has("time.accuracy"))
            settings.remove(key);
        else if (given.has(key))
            settings.remove("time.accuracy");
    }
}

void remove_rivals(Settings& settings, const Settings& given) {
    remove_rivals_of_accuracy(settings, given);
    for (const auto& [a, b] : rivals) {
        if (given.has(a) && !given.has(b)) settings.remove(b);
        if (given.has(b) && !given.has(a)) settings.remove(a);
    }
    const bool lists_discs = given.has("discs.file") || given.has("discs.list");
    if (lists_discs) settings.remove("discs.generator");
    const Setting* setting = given.find("discs.generator");
    if (!lists_discs && !setting) return;
    const std::string generator = setting ? std::get<std::string>(setting->value) : "file";
    const std::vector<Setting> present = settings.all();
    for (const Setting& other : present)
        if (!has_meaning_for(generator, other.key)) settings.remove(other.key);
}

} // namespace

void add_overrides(Settings& settings, Problems& problems,
                   const std::vector<std::string>& overrides) {
    Settings given;
    for (const std::string& text : overrides) {
        const std::size_t equals = text.find('=');
        const std::string key{trimmed(std::string_view(text).substr(0, equals))};
        const Place place{"--set " + (key.empty() ? text : key), 0};
        if (equals == std::string::npos || key.empty())
            add_problem(problems, place,
                        fmt::format("{} is not of the form key=value", quoted(text)));
        else if (!kind_of_key(key))
            add_problem(problems, place, unknown_key_text(key));
        else
            add_toml_value(given, problems, key,
                           std::string(trimmed(std::string_view(text).substr(equals + 1))), place);
    }
    remove_rivals(settings, given);
    for (const Setting& setting : given.all()) settings.set(setting);
}

} // namespace carrom
