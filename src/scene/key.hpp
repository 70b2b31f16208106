// SPDX-License-Identifier: BSD-3-Clause
// Scene keys are declared once, with the types of this file. The reader of scenes, its checks,
// `--set`, comparisons at restarts, the writer of scenes and the reference page use them.
//
// To add a key: add a member to SceneParameters, and declare the key in the file of its effect or
// kind of side, or in a keys_of_*.cpp. If it cannot be combined with another key, add a rule in the
// same file or in rules.cpp.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/scene_parameters.hpp"
#include "scene/settings.hpp"

namespace carrom {

enum class Kind {
    number,
    lengths, ///< a number, or an array of two, [Lx, Ly]
    point,   ///< two coordinates [x, y], or a word of the key
    integer,
    flag,
    text,
    choice, ///< one of the words of the key
    words,  ///< an array of words of the key
    rows,   ///< an array of arrays of numbers
    tables  ///< an array of tables of numbers
};

/// How a number scales with units: the exponents of length, time and mass.
struct Dimension {
    int length = 0, time = 0, mass = 0;

    friend bool operator==(const Dimension&, const Dimension&) = default;
};
/// The dimension of a unit such as "mass length^2/step^2". Other words are ignored.
Dimension dimension_of(std::string_view unit);

/// The allowed range of a number. The ends are included, but `low` is not if `excludes_low` is set.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool excludes_low = false;
    bool allows_zero = false; ///< whether 0 is allowed even outside of the range
    std::string_view why = "";
};

/// A condition that a key depends on: without it the key has no meaning.
struct Need {
    std::string text; ///< the missing condition; ends the message "... has no meaning ..."
    std::function<bool(const SceneParameters&)> holds;
    bool is_of_generator = false; ///< the condition concerns how discs are generated
};

/// The numbers of one key of a table, or all numbers of a row: Kind::tables has one field for each
/// key of a table, Kind::rows one field without a name. Numbers that the form calls x or y, or x0,
/// y0, x1 and so on, are places (scene/places.hpp).
struct Field {
    std::string_view name;
    std::string_view form; ///< the shape of the numbers, such as "[x, y, radius]"
    std::size_t least = 1, most = 1;
    std::optional<double> fallback = {}; ///< default; NaN if optional; unset if required
    /// The allowed words; the stored number is the index of the word. The words "false" and "true"
    /// of a flag have no quotes.
    std::vector<std::string_view> words = {};

    bool is_flag() const { return !words.empty() && words.front() == "false"; }
};

/// A key of scenes, made by a function of key_members.hpp. The functions below that return
/// `Key&&` complete the declaration.
struct Key {
    std::string name;
    std::string_view unit, help;
    std::string_view fallback = ""; ///< describes the default, if words are better than the value
    Range range = {};
    std::optional<Need> need = {};
    bool is_required = false;                      ///< the input must give it if `need` holds
    bool is_seed = false;                          ///< replicas get different values
    bool is_physical = true;                       ///< a restart cannot change it
    std::vector<std::string_view> instead_of = {}; ///< keys that cannot be given together with it
    /// If the key is required: keys any of which may be given instead of it
    std::vector<std::string_view> or_from = {};
    std::string_view old_name = "";
    /// Words that other programs use for values of this key, each with advice for an error message.
    std::vector<std::pair<std::string_view, std::string_view>> advice = {};
    std::vector<Field> fields = {};
    /// For Kind::rows: a single row may be written without the outer brackets
    bool is_one_row = false;
    std::optional<Axis> axis = {}; ///< the axis, if the number is a coordinate

    // The functions of key_members.hpp set the following from the key's member of SceneParameters.
    Kind kind = Kind::number;
    std::vector<std::string_view> words = {};
    /// Old words of the key, each with the word that replaces it
    std::vector<std::pair<std::string_view, std::string_view>> old_words = {};
    /// Returns the value, or nothing if it need not be written.
    std::function<Value(const SceneParameters&)> get = {};
    std::function<void(SceneParameters&, const Value&)> set = {};
    /// Whether two scenes have equal values of the key; set if `get` returns only part of a value.
    std::function<bool(const SceneParameters&, const SceneParameters&)> compare = {};

    using Names = std::vector<std::string_view>;
    Key&& by_default(std::string_view text) && { return fallback = text, std::move(*this); }
    Key&& within(const Range& numbers) && { return range = numbers, std::move(*this); }
    Key&& needs(const Need& other) && { return need = other, std::move(*this); }
    Key&& required() && { return is_required = true, std::move(*this); }
    Key&& not_physical() && { return is_physical = false, std::move(*this); }
    Key&& seed() && { return is_seed = true, std::move(*this); }
    Key&& advises(const std::vector<std::pair<std::string_view, std::string_view>>& texts) && {
        return advice = texts, std::move(*this);
    }
    Key&& excludes(const Names& names) && { return instead_of = names, std::move(*this); }
    Key&& unless(const Names& names) && { return or_from = names, std::move(*this); }
    Key&& formerly(std::string_view old) && { return old_name = old, std::move(*this); }
    Key&& place_along(Axis of) && { return axis = of, std::move(*this); }
    Key&& with_rows(const std::vector<Field>& of) && {
        kind = of.size() > 1 ? Kind::tables : Kind::rows;
        return fields = of, std::move(*this);
    }

    Dimension dimension() const { return dimension_of(unit); }
    std::string_view table() const { return std::string_view(name).substr(0, name.rfind('.')); }
    bool has_rows() const { return kind == Kind::rows || kind == Kind::tables; }
    bool is_same(const SceneParameters& a, const SceneParameters& b) const {
        return compare ? compare(a, b) : get(a) == get(b);
    }
    bool has_meaning(const SceneParameters& scene) const { return !need || need->holds(scene); }
};

/// A table of a scene's TOML text, such as [time].
struct Table {
    std::string name;
    std::string_view help = "";
    bool (*is_in)(const SceneParameters&) = [](const SceneParameters&) { return true; };
    void (*create)(SceneParameters&) = [](SceneParameters&) {};
    bool is_like_another = false; ///< the reference page describes it with another table

    /// Whether a scene may leave out the table because its feature is optional.
    bool is_optional() const { return !is_in(SceneParameters{}); }
};

/// Two features that cannot be combined.
struct Rule {
    std::string_view one, other, why;
    /// A scene that breaks the rule gets an error at the first of these keys that it contains
    std::vector<std::string_view> keys;
    std::optional<BoundaryKind> boundary = {}; ///< or the error is at a side of this kind
    bool (*is_broken)(const SceneParameters&);
};

/// All keys, in the order of the reference page docs/reference/keys.md.
const std::vector<Key>& keys();
const std::vector<Table>& tables();
const std::vector<Rule>& rules();

const Key* find_key(std::string_view name);
const Table* find_table(std::string_view name);

/// The scene's effects with the micro-step as the unit of time, as the dynamics needs them. Numbers
/// are converted according to the units of their keys.
Effects per_micro_step(const SceneParameters& scene);

std::vector<Key> keys_of_discs();
std::vector<Key> keys_of_sizes(); ///< the keys of the table [discs.radius]
std::vector<Key> keys_of_time();
std::vector<Key> keys_of_machine();
std::vector<Key> keys_of_effects();
std::vector<Key> keys_of_output();

std::vector<Rule> rules_of_machine();

} // namespace carrom
