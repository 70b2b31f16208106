// SPDX-License-Identifier: BSD-3-Clause
// The settings of an input, key by key, before anything is checked. They are the common
// form of TOML scenes, legacy text and `--set key=value`. Each setting contains its
// file and line, so that error messages can name them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/errors.hpp"

namespace carrom {

using Problems = std::vector<Problem>;

struct Place {
    std::string name;
    std::int64_t line = 0; ///< line number; 0 if there are no lines, as for `--set`
};

struct Value;
using Numbers = std::vector<double>;
using Values = std::vector<Value>;
using NamedValues = std::vector<std::pair<std::string, Value>>;

/// A value of TOML. Checks turn rows of numbers into Numbers, and an invalid row into `monostate`,
/// so that the rows after it keep their positions.
struct Value {
    std::variant<std::monostate, bool, std::int64_t, double, std::string, Numbers, Values,
                 NamedValues>
        data{};
    std::int64_t line = 0;

    bool is_nothing() const { return data.index() == 0; }
    friend bool operator==(const Value& a, const Value& b) { return a.data == b.data; }
};

struct Setting {
    std::string key;
    Place place;
    Value value;
    bool is_wrong = false; ///< a problem has been reported; the value must not be used
};

/// Settings in the order of the input. Each table of the input is also a setting.
class Settings {
public:
    const Setting* find(std::string_view key) const {
        const auto found = std::find_if(all_.begin(), all_.end(),
                                        [key](const Setting& one) { return one.key == key; });
        return found == all_.end() ? nullptr : &*found;
    }
    /// The setting, for checks that complete its value, such as counts that follow from other
    /// keys.
    Setting* find_to_complete(std::string_view key) {
        const auto found = std::ranges::find(all_, key, &Setting::key);
        return found == all_.end() ? nullptr : &*found;
    }
    bool has(std::string_view key) const { return find(key) != nullptr; }
    /// Whether the input has the key with a valid value.
    bool is_right(std::string_view key) const { return has(key) && !find(key)->is_wrong; }

    std::vector<Setting>& all() { return all_; }
    const std::vector<Setting>& all() const { return all_; }

    /// Adds the setting, or replaces the one with the same key.
    void set(Setting setting) {
        remove(setting.key);
        all_.push_back(std::move(setting));
    }
    void remove(std::string_view key) {
        std::erase_if(all_, [key](const Setting& one) { return one.key == key; });
    }

private:
    std::vector<Setting> all_;
};

inline void add_problem(Problems& problems, const Place& place, std::string text) {
    problems.push_back({place.name, place.line, std::move(text)});
}

} // namespace carrom
