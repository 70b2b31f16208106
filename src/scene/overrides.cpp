// SPDX-License-Identifier: BSD-3-Clause
#include "scene/overrides.hpp"

#include <algorithm>
#include <initializer_list>
#include <vector>

#include <fmt/format.h>

#include "scene/checked_value.hpp"
#include "scene/number.hpp"
#include "scene/toml_text.hpp"
#include "scene/unknown_key.hpp"

namespace carrom {

namespace {

bool list_discs(const Settings& settings) {
    return settings.has("discs.file") || settings.has("discs.list") || settings.has("discs.from");
}

/// Removes keys of the input that have no meaning for the generator that the command line chooses.
/// `were_listed`: the input lists discs.
void remove_keys_of_other_generators(Settings& settings, const Settings& given, bool were_listed) {
    const bool lists_discs = list_discs(given);
    if (lists_discs) settings.remove("discs.generator");
    SceneParameters chosen;
    chosen.draws_velocities = were_listed; // so that listed discs keep the input's speed
    if (given.is_right("discs.generator"))
        find_key("discs.generator")->set(chosen, given.find("discs.generator")->value);
    else if (lists_discs)
        chosen.generator = Generator::file;
    else
        return;
    std::erase_if(settings.all(), [&chosen](const Setting& one) {
        const Key* other = find_key(one.key);
        return other && other->need && other->need->is_of_generator && !other->has_meaning(chosen);
    });
}

/// Stores the valid settings in each scene. Lists of rows are left out, because they are long, and
/// so are the keys of optional tables.
void take_right_values(const std::vector<Setting>& all,
                       std::initializer_list<SceneParameters*> scenes) {
    for (const Setting& one : all) {
        const Key* key = find_key(one.key);
        if (!key || one.is_wrong || key->has_rows() || find_table(key->table())->is_optional())
            continue;
        Setting setting = one;
        Problems ignored; // fill_scene reports problems
        check_value(*key, setting, ignored);
        if (setting.is_wrong) continue;
        for (SceneParameters* scene : scenes) key->set(*scene, setting.value);
    }
}

/// Removes keys of the input that have no meaning with a word given on the command line, and keys
/// that need a removed key. For example, kind = "langevin" removes the strength of kicks.
void remove_keys_of_other_kinds(Settings& settings, const Settings& given) {
    const auto has_word_for = [&given](const Key& other) {
        return std::any_of(given.all().begin(), given.all().end(), [&other](const Setting& one) {
            const Key* key = find_key(one.key);
            return key && key->kind == Kind::choice && key->table() == other.table();
        });
    };
    SceneParameters before;
    take_right_values(settings.all(), {&before});
    std::size_t n_removed = 1;
    while (n_removed > 0) {
        SceneParameters after;
        take_right_values(settings.all(), {&after});
        take_right_values(given.all(), {&after});
        n_removed = std::erase_if(settings.all(), [&](const Setting& one) {
            const Key* key = find_key(one.key);
            return key && !given.has(one.key) && has_word_for(*key) && key->has_meaning(before) &&
                   !key->has_meaning(after);
        });
    }
}

/// Reports wrong values in the input even if the command line replaces them.
void check_replaced(Settings& settings, const Settings& given, Problems& problems) {
    for (Setting& setting : settings.all()) {
        const Key* key = find_key(setting.key);
        if (key && !setting.is_wrong && given.is_right(setting.key))
            check_value(*key, setting, problems);
    }
}

/// Some keys, such as 'discs.radius', are either a value or a table. If the command line gives one
/// form, this removes the other form from the input.
void remove_other_forms(Settings& settings, const Settings& given) {
    std::erase_if(settings.all(), [&given](const Setting& one) {
        const Key* key = find_key(one.key);
        if (!key) return false;
        if (find_key(key->table()) && given.has(key->table())) return true;
        return find_table(one.key) &&
               std::any_of(given.all().begin(), given.all().end(), [&one](const Setting& other) {
                   const Key* inner = find_key(other.key);
                   return inner && inner->table() == one.key;
               });
    });
}

/// Removes settings of the input that cannot be combined with those of the command line.
void remove_rivals(Settings& settings, const Settings& given) {
    const bool were_listed = list_discs(settings);
    for (const Key& key : keys()) {
        for (const std::string_view other : key.instead_of) {
            if (given.has(key.name)) settings.remove(other);
            if (given.has(other)) settings.remove(key.name);
        }
    }
    remove_other_forms(settings, given);
    remove_keys_of_other_generators(settings, given, were_listed);
    remove_keys_of_other_kinds(settings, given);
}

void add_table(Settings& given, Problems& problems, const Place& place, const std::string& table,
               const NamedValues& values) {
    for (const auto& [part, value] : values) {
        const std::string name = fmt::format("{}.{}", table, part);
        const auto* inner = std::get_if<NamedValues>(&value.data);
        if (inner && find_table(name))
            add_table(given, problems, place, name, *inner);
        else if (find_key(name))
            given.set({name, place, value});
        else
            add_problem(problems, place, unknown_key_text(name, value));
    }
}

/// The text of a word, without quotes if it has any.
std::string unquoted(const std::string& word) {
    const bool is_quoted = word.size() > 1 && (word[0] == '"' || word[0] == '\'') &&
                           word.back() == word[0];
    return is_quoted ? word.substr(1, word.size() - 2) : word;
}

/// Adds the settings in `table={key = value}`, which means `table.key=value`, as in scenes.
void add_inline_table(Settings& given, Problems& problems, const Place& place,
                      const std::string& name, const std::string& text) {
    const auto values = parse_table(text);
    if (values)
        add_table(given, problems, place, name, *values);
    else
        add_problem(problems, place,
                    fmt::format("must be a table of TOML, {{key = value, other_key = \"word\"}}, "
                                "not {}; quote it for the shell, or try: --set {}.KEY=VALUE",
                                in_quotes(text), name));
}

} // namespace

std::string form_problem(const std::string& text) {
    const Key* key = find_key(trimmed(text));
    return fmt::format("{} is not of the form key=value{}", in_quotes(text),
                       key ? fmt::format("; its value is {}", kind_text(*key)) : "");
}

void add_overrides(Settings& settings, Problems& problems,
                   const std::vector<std::string>& overrides) {
    Settings given;
    for (const std::string& text : overrides) {
        const std::size_t equals = text.find('=');
        const std::string name{trimmed(std::string_view(text).substr(0, equals))};
        const Place place{"--set " + (name.empty() ? text : name), 0};
        const std::string word = equals == std::string::npos
                                     ? ""
                                     : std::string(
                                           trimmed(std::string_view(text).substr(equals + 1)));
        const Key* key = find_key(name);
        if (equals == std::string::npos || name.empty()) {
            add_problem(problems, place, form_problem(text));
        } else if (text.find('\n') != std::string::npos) { // checkpoints store overrides as
                                                           // lines
            add_problem(problems, place,
                        fmt::format("must stand on one line, not {}", in_quotes(word)));
        } else if (word.starts_with('{') && find_table(name)) {
            add_inline_table(given, problems, place, name, word);
        } else if (!key) {
            add_problem(problems, place, unknown_key_text(name, Value{unquoted(word)}));
        } else {
            const auto value = parse_value(*key, word);
            if (!value)
                add_problem(problems, place,
                            fmt::format("must be {}, not {}", kind_text(*key), in_quotes(word)));
            given.set({name, place, value.value_or(Value{}), !value});
        }
    }
    remove_rivals(settings, given);
    check_replaced(settings, given, problems);
    for (const Setting& setting : given.all())
        if (!setting.is_wrong || !settings.has(setting.key)) settings.set(setting);
}

} // namespace carrom
