// SPDX-License-Identifier: BSD-3-Clause
#include "scene/quantity.hpp"

#include <algorithm>

#include "scene/key_members.hpp"

namespace carrom {

namespace {

/// A local static, because declarations may be stored before this file's static data are
/// initialised.
std::vector<Quantity>& list() {
    static std::vector<Quantity> declared;
    return declared;
}

/// Text such as "a", "b" or "c".
std::string listed(const std::vector<std::string_view>& names) {
    std::string text;
    for (std::size_t k = 0; k < names.size(); ++k)
        text += fmt::format("{}\"{}\"",
                            k == 0                 ? ""
                            : k + 1 < names.size() ? ", "
                                                   : " or ",
                            names[k]);
    return text;
}

Need one_of(std::vector<std::string_view> names) {
    std::string text = "without " + listed(names) + " among 'output.measurements.quantities'";
    return {std::move(text), [names = std::move(names)](const SceneParameters& s) {
                return std::any_of(names.begin(), names.end(),
                                   [&s](std::string_view name) { return measures(s, name); });
            }};
}

Key setting_key(const QuantitySetting& setting, Kind kind, std::string_view unit,
                std::string_view help, std::string_view by_default) {
    Key key = named_key(setting.key_name(), unit, help);
    key.kind = kind;
    key.fallback = by_default;
    key.get = [setting, kind, has_fixed = by_default.empty()](const SceneParameters& s) {
        if (!has_fixed && !s.measurements->is_given(setting.name)) return Value{};
        const double value = setting.of(*s.measurements);
        return kind == Kind::integer ? Value{static_cast<std::int64_t>(value)} : Value{value};
    };
    key.set = [setting](SceneParameters& s, const Value& value) {
        const auto* whole = std::get_if<std::int64_t>(&value.data);
        s.measurements->give(std::string(setting.name),
                             whole ? static_cast<double>(*whole) : std::get<double>(value.data));
    };
    return key;
}

void run_once(const SceneDraft& draft, void (*Quantity::*of)(const SceneDraft&)) {
    std::vector<void (*)(const SceneDraft&)> done;
    for (const Quantity& quantity : list()) {
        const auto run = quantity.*of;
        if (!run || !measures(draft.scene, quantity.name)) continue;
        if (std::find(done.begin(), done.end(), run) != done.end()) continue;
        run(draft);
        done.push_back(run);
    }
}

} // namespace

void declare_quantities(std::vector<Quantity> all) { list() = std::move(all); }

const std::vector<Quantity>& declared_quantities() { return list(); }

Key QuantitySetting::number(std::string_view unit, std::string_view help,
                            std::string_view by_default) const {
    return setting_key(*this, Kind::number, unit, help, by_default);
}

Key QuantitySetting::integer(std::string_view unit, std::string_view help,
                             std::string_view by_default) const {
    return setting_key(*this, Kind::integer, unit, help, by_default);
}

std::vector<Key> keys_of_quantities() {
    std::vector<Key> keys;
    std::vector<std::vector<std::string_view>> users;
    for (const Quantity& quantity : list()) {
        for (const Key& key : quantity.keys) {
            const auto found = std::find_if(
                keys.begin(), keys.end(), [&key](const Key& one) { return one.name == key.name; });
            const auto place = static_cast<std::size_t>(found - keys.begin());
            if (found == keys.end()) {
                keys.push_back(key);
                users.emplace_back();
            }
            users[place].push_back(quantity.name);
        }
    }
    for (std::size_t k = 0; k < keys.size(); ++k) keys[k].need = one_of(users[k]);
    return keys;
}

std::vector<Rule> rules_of_quantities() {
    std::vector<Rule> rules = {
        {.one = "effects.barostat.axes = \"each\"",
         .other = "a quantity of places, waves or displacements",
         .why = "its table needs a box whose sides stay as they are; take axes = \"together\"",
         .keys = {"effects.barostat.axes"},
         .is_broken = [](const SceneParameters& s) {
             return s.effects.barostat.axes == BarostatAxes::each &&
                    std::ranges::any_of(list(), [&s](const Quantity& quantity) {
                        return quantity.needs_lasting_sides && measures(s, quantity.name);
                    });
         }}};
    for (const Quantity& quantity : list())
        rules.insert(rules.end(), quantity.rules.begin(), quantity.rules.end());
    return rules;
}

void check_quantities(const SceneDraft& draft) { run_once(draft, &Quantity::check); }

void check_times_of_quantities(const SceneDraft& draft) { run_once(draft, &Quantity::check_times); }

} // namespace carrom
