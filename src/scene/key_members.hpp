// SPDX-License-Identifier: BSD-3-Clause
// Makes keys for members of SceneParameters. The member's type gives the key's kind and its words.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <type_traits>

#include "scene/key.hpp"

namespace carrom {

template <class Enum> struct Word {
    std::string_view name;
    Enum value;
    std::string_view old_name = "";
};
/// Needed by Clang 14, which does not deduce `Enum` from the members of a Word.
template <class Enum> Word(std::string_view, Enum) -> Word<Enum>;

/// The words that stand for the values of an enumeration in scenes.
template <class Enum> inline constexpr std::array<Word<Enum>, 0> words_of{};
template <>
inline constexpr std::array words_of<Method>{
    Word<Method>{"time-stepped", Method::time_stepped, "one"},
    Word<Method>{"event-driven", Method::event_driven, "all"}};
template <>
inline constexpr std::array words_of<Precision>{Word{"double", Precision::double_},
                                                Word{"single", Precision::single}};
template <>
inline constexpr std::array words_of<Arithmetic>{Word{"stable", Arithmetic::stable},
                                                 Word{"naive", Arithmetic::naive}};
template <>
inline constexpr std::array words_of<Generator>{
    Word<Generator>{"random", Generator::random},
    Word<Generator>{"lattice", Generator::lattice},
    Word<Generator>{"triangular", Generator::triangular},
    Word<Generator>{"compressed", Generator::compressed},
    Word<Generator>{"legacy", Generator::legacy, "ancestor"},
    Word<Generator>{"file", Generator::file}};
template <>
inline constexpr std::array words_of<VelocityKind>{Word{"maxwell", VelocityKind::maxwell},
                                                   Word{"uniform", VelocityKind::uniform},
                                                   Word{"reversed", VelocityKind::reversed}};
template <>
inline constexpr auto words_of<DiscColumn> = [] {
    constexpr auto n_first = static_cast<std::size_t>(DiscColumn::first_side);
    std::array<Word<DiscColumn>, n_first + n_given_columns> words{
        Word{"id", DiscColumn::id},    Word{"x", DiscColumn::x},
        Word{"y", DiscColumn::y},      Word{"vx", DiscColumn::vx},
        Word{"vy", DiscColumn::vy},    Word{"radius", DiscColumn::radius},
        Word{"mass", DiscColumn::mass}};
    for (const SideColumn column : given_side_columns)
        words[n_first + static_cast<std::size_t>(column)] = {info_of(column).name,
                                                             disc_column_of(column)};
    return words;
}();
template <>
inline constexpr std::array words_of<ContactKind>{
    Word{"elastic", ContactKind::elastic}, Word{"none", ContactKind::none},
    Word{"restitution", ContactKind::restitution}, Word{"rough", ContactKind::rough}};
template <>
inline constexpr auto words_of<BoundaryKind> = [] {
    std::array<Word<BoundaryKind>, boundary_words.size()> words;
    for (std::size_t k = 0; k < words.size(); ++k)
        words[k] = {boundary_words[k], static_cast<BoundaryKind>(k)};
    return words;
}();
template <>
inline constexpr std::array words_of<BoxShape>{Word{"rectangle", BoxShape::rectangle},
                                               Word{"round", BoxShape::round},
                                               Word{"stadium", BoxShape::stadium}};
template <>
inline constexpr std::array words_of<Transfers>{Word{"independent", Transfers::independent},
                                                Word{"collective", Transfers::collective}};
template <>
inline constexpr std::array words_of<TextOutput>{Word{"none", TextOutput::none},
                                                 Word{"ends", TextOutput::first_and_last},
                                                 Word{"every_step", TextOutput::every_step}};

template <> inline constexpr std::array words_of<Axis>{Word{"x", Axis::x}, Word{"y", Axis::y}};

template <class T> inline constexpr bool is_list = false;
template <class T> inline constexpr bool is_list<std::vector<T>> = true;
template <class T> inline constexpr bool is_optional = false;
template <class T> inline constexpr bool is_optional<std::optional<T>> = true;

/// The members of `Row`, a struct of doubles only, in the order of the numbers in a scene's row.
template <class Row> using RowNumbers = std::array<double, sizeof(Row) / sizeof(double)>;

template <class Member> constexpr Kind kind_of() {
    if constexpr (std::same_as<Member, bool>)
        return Kind::flag;
    else if constexpr (std::same_as<Member, Box>)
        return Kind::lengths;
    else if constexpr (std::same_as<Member, Origin>)
        return Kind::point;
    else if constexpr (std::is_enum_v<Member>)
        return Kind::choice;
    else if constexpr (std::integral<Member>)
        return Kind::integer;
    else if constexpr (std::floating_point<Member>)
        return Kind::number;
    else if constexpr (std::same_as<Member, std::string>)
        return Kind::text;
    else if constexpr (is_optional<Member>)
        return kind_of<typename Member::value_type>();
    else if constexpr (std::is_enum_v<typename Member::value_type>)
        return Kind::words;
    else
        return Kind::rows;
}

template <class Member> void assign(Member& member, const Value& value) {
    if constexpr (std::is_enum_v<Member>) {
        for (const auto& word : words_of<Member>)
            if (word.name == std::get<std::string>(value.data)) member = word.value;
    } else if constexpr (std::same_as<Member, Box>) {
        const auto* edges = std::get_if<Numbers>(&value.data);
        member = edges ? Box((*edges)[0], (*edges)[1]) : Box(std::get<double>(value.data));
    } else if constexpr (std::same_as<Member, Origin>) {
        const auto* place = std::get_if<Numbers>(&value.data);
        member = place ? Origin{(*place)[0], (*place)[1]} : Origin{.is_centre = true};
    } else if constexpr (is_optional<Member>) {
        assign(member.emplace(), value);
    } else if constexpr (is_list<Member>) {
        member.clear();
        for (const Value& one : std::get<Values>(value.data)) {
            if (one.is_nothing()) continue; // an invalid row has been reported already
            if constexpr (std::is_enum_v<typename Member::value_type>) {
                assign(member.emplace_back(), one);
            } else {
                RowNumbers<typename Member::value_type> row{};
                std::copy_n(std::get<Numbers>(one.data).begin(), row.size(), row.begin());
                member.push_back(std::bit_cast<typename Member::value_type>(row));
            }
        }
    } else if constexpr (std::integral<Member> && !std::same_as<Member, bool>) {
        member = static_cast<Member>(std::get<std::int64_t>(value.data));
    } else {
        member = std::get<Member>(value.data);
    }
}

template <class Member> Value value_of(const Member& member) {
    if constexpr (std::is_enum_v<Member>) {
        for (const auto& word : words_of<Member>)
            if (word.value == member) return {std::string(word.name)};
        return {};
    } else if constexpr (std::same_as<Member, Box>) {
        return member.is_square() ? Value{member.x} : Value{Numbers{member.x, member.y}};
    } else if constexpr (std::same_as<Member, Origin>) {
        return member.is_centre ? Value{std::string("centre")} : Value{Numbers{member.x, member.y}};
    } else if constexpr (is_optional<Member>) {
        return member ? value_of(*member) : Value{};
    } else if constexpr (is_list<Member>) {
        Values values;
        for (const auto& one : member) {
            if constexpr (std::is_enum_v<typename Member::value_type>) {
                values.push_back(value_of(one));
            } else {
                const auto row = std::bit_cast<RowNumbers<typename Member::value_type>>(one);
                values.push_back({Numbers(row.begin(), row.end())});
            }
        }
        return {std::move(values)};
    } else if constexpr (std::integral<Member> && !std::same_as<Member, bool>) {
        return {static_cast<std::int64_t>(member)};
    } else {
        return {member};
    }
}

template <class Enum> void add_words(Key& key) {
    for (const auto& word : words_of<Enum>) {
        key.words.push_back(word.name);
        if (!word.old_name.empty()) key.old_words.emplace_back(word.old_name, word.name);
    }
}

/// Makes a key that is not connected to a member of SceneParameters yet.
inline Key named_key(std::string name, std::string_view unit, std::string_view help) {
    Key named;
    named.name = std::move(name);
    named.unit = unit;
    named.help = help;
    return named;
}

/// A key for the member to which `member(scene)` returns a reference; the scene may be const.
template <class Get>
Key key(std::string name, std::string_view unit, std::string_view help, const Get& member) {
    Key declared = named_key(std::move(name), unit, help);
    using Member = std::remove_cvref_t<decltype(member(std::declval<SceneParameters&>()))>;
    declared.kind = kind_of<Member>();
    if constexpr (std::is_enum_v<Member>) add_words<Member>(declared);
    if constexpr (is_list<Member>)
        if constexpr (std::is_enum_v<typename Member::value_type>)
            add_words<typename Member::value_type>(declared);
    declared.get = [member](const SceneParameters& scene) { return value_of(member(scene)); };
    declared.set = [member](SceneParameters& scene, const Value& value) {
        assign(member(scene), value);
    };
    return declared;
}

/// A key for a number that only its effect uses; OwnNumbers stores the number.
inline Key own_key(const std::string& name, std::string_view unit, std::string_view help) {
    Key declared = named_key(name, unit, help);
    declared.kind = Kind::number;
    declared.get = [name](const SceneParameters& scene) {
        return Value{scene.effects.own.of(name)};
    };
    declared.set = [name](SceneParameters& scene, const Value& value) {
        scene.effects.own.set(name, std::get<double>(value.data));
    };
    return declared;
}

/// A word, and the flag that it sets.
template <class Object> struct Flag {
    std::string_view word;
    std::function<bool&(Object&)> of;
};

/// A key that is a list of words, each of which sets a flag of the object that `member` returns.
template <class Get, class Object>
Key flags_key(std::string name, std::string_view unit, std::string_view help, const Get& member,
              const std::vector<Flag<Object>>& flags) {
    Key declared = named_key(std::move(name), unit, help);
    declared.kind = Kind::words;
    for (const auto& flag : flags) declared.words.push_back(flag.word);
    declared.get = [member, flags](const SceneParameters& scene) {
        Object object = member(scene);
        Values words;
        for (const auto& flag : flags)
            if (flag.of(object)) words.push_back({std::string(flag.word)});
        return Value{std::move(words)};
    };
    declared.set = [member, flags](SceneParameters& scene, const Value& value) {
        const Values& words = std::get<Values>(value.data);
        for (const auto& flag : flags)
            flag.of(member(scene)) = std::any_of(words.begin(), words.end(), [&](const Value& one) {
                return std::get<std::string>(one.data) == flag.word;
            });
    };
    return declared;
}

} // namespace carrom
