// SPDX-License-Identifier: BSD-3-Clause
// The one declaration of each scene key. The reader of scenes and its checks, `--set`, the
// comparison at a restart, the writer of scenes and the reference page all work from this table.
//
// To add a key: add a member to SceneParameters, and declare the key in the file of its effect or
// side, or in a keys_of_*.cpp. What it does not go with is a rule there, or a row of rules.cpp.
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
    lengths, ///< a number, or two of them, [Lx, Ly]
    point,   ///< a word of the key, or [x, y]
    integer,
    flag,
    text,
    choice, ///< one of the key's words
    words,  ///< an array of them
    rows,   ///< an array of arrays of numbers
    tables  ///< an array of tables of numbers
};

/// How a number scales: its exponents of the units of length, time and mass.
struct Dimension {
    int length = 0, time = 0, mass = 0;

    friend bool operator==(const Dimension&, const Dimension&) = default;
};
/// Of a unit such as "mass length^2/step^2". Other words count nothing.
Dimension dimension_of(std::string_view unit);

/// What a number may be, ends included.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool excludes_low = false;
    bool allows_zero = false; ///< besides
    std::string_view why = "";
};

/// What a key has no meaning without.
struct Need {
    std::string text; ///< goes on after "has no meaning"
    std::function<bool(const SceneParameters&)> holds;
    bool is_of_generator = false; ///< depends on discs.generator alone
};

/// The numbers of a row: one nameless field for Kind::rows, those of the table for Kind::tables.
/// Numbers that the form calls x or y, or x0, y0, x1 and so on, are places (scene/places.hpp).
struct Field {
    std::string_view name;
    std::string_view form; ///< "[x, y, radius]"
    std::size_t least = 1, most = 1;
    std::optional<double> fallback = {}; ///< NaN: there may be none
    /// The words that it takes; its number is the place of the word. "false" and "true" are those
    /// of a flag, which stand without quotes.
    std::vector<std::string_view> words = {};

    bool is_flag() const { return !words.empty() && words.front() == "false"; }
};

/// Made by `key` (key_members.hpp); the functions that return `Key&&` add to a declaration.
struct Key {
    std::string name;
    std::string_view unit, help;
    std::string_view fallback = ""; ///< the default, where words say it better than the value
    Range range = {};
    std::optional<Need> need = {};
    bool is_required = false;                      ///< wherever the need holds
    bool is_seed = false;                          ///< replicas have different ones
    bool is_physical = true;                       ///< a restart cannot change it
    std::vector<std::string_view> instead_of = {}; ///< keys that it excludes
    std::vector<std::string_view> or_from = {};    ///< keys that save a required one
    std::string_view old_name = "";
    /// Words of other programs, and what to write here.
    std::vector<std::pair<std::string_view, std::string_view>> advice = {};
    std::vector<Field> fields = {};
    bool is_one_row = false;       ///< of Kind::rows; it may stand without the outer brackets
    std::optional<Axis> axis = {}; ///< of a number that is a place: the axis it lies along

    // Filled in from the member:
    Kind kind = Kind::number;
    std::vector<std::string_view> words = {};
    std::vector<std::pair<std::string_view, std::string_view>> old_words = {}; ///< and new ones
    /// The value; nothing if it is not to be written.
    std::function<Value(const SceneParameters&)> get = {};
    std::function<void(SceneParameters&, const Value&)> set = {};
    /// True if two scenes have the same here; set where `get` cannot give all of it.
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

/// A table that keys stand in.
struct Table {
    std::string name;
    std::string_view help = "";
    bool (*is_in)(const SceneParameters&) = [](const SceneParameters&) { return true; };
    void (*create)(SceneParameters&) = [](SceneParameters&) {};
    bool is_like_another = false; ///< the reference shows the other one

    /// A scene without the table lacks what it is about.
    bool is_optional() const { return !is_in(SceneParameters{}); }
};

/// Two features that do not go together.
struct Rule {
    std::string_view one, other, why;
    std::vector<std::string_view> keys;        ///< the first of them that is there has the problem
    std::optional<BoundaryKind> boundary = {}; ///< or the first side of this kind
    bool (*is_broken)(const SceneParameters&);
};

/// All of them, in the order of the reference.
const std::vector<Key>& keys();
const std::vector<Table>& tables();
const std::vector<Rule>& rules();

const Key* find_key(std::string_view name);
const Table* find_table(std::string_view name);

/// The scene's effects with the micro-step as the unit of time, as a dynamics counts it. Units of
/// keys say which numbers that changes.
Effects per_micro_step(const SceneParameters& scene);

std::vector<Key> keys_of_discs();
std::vector<Key> keys_of_sizes(); ///< discs.radius as a table
std::vector<Key> keys_of_time();
std::vector<Key> keys_of_machine();
std::vector<Key> keys_of_effects();
std::vector<Key> keys_of_output();

std::vector<Rule> rules_of_machine();

} // namespace carrom
