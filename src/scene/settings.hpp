// SPDX-License-Identifier: BSD-3-Clause
// What an input asks for, key by key, before anything is checked: the common form of TOML scenes,
// legacy text and
// `--set key=value`. Each setting remembers where it stands, so that every problem can name its
// line.
#pragma once

#include <cstddef>
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
    std::int64_t line = 0;
};

/// One row of numbers of `discs.list`, four to seven, or of the obstacles' lists; empty where
/// something else was written, a problem by then.
struct Row {
    Place place;
    std::vector<double> numbers;
};

/// `discs.streams`: region and velocity as written.
struct StreamRows {
    Place place;
    std::size_t number = 0; ///< among the streams, from 1
    std::vector<double> region, velocity;
};

/// One of `discs.species` as written.
struct SpeciesRow {
    Place place;
    std::size_t number = 0; ///< among the classes, from 1
    double count = 0, radius = 0, mass = 1, spin = 0;
};

struct Setting {
    std::string key;
    Place place;
    std::variant<bool, std::int64_t, double, std::string, std::vector<std::string>,
                 std::vector<Row>, std::vector<StreamRows>, std::vector<SpeciesRow>>
        value;
};

class Settings {
public:
    const Setting* find(std::string_view key) const;
    const std::vector<Setting>& all() const { return settings_; }
    bool has(std::string_view key) const { return find(key) != nullptr; }

    /// Adds the setting; one of the same key is replaced.
    void set(Setting setting);
    void remove(std::string_view key);

    /// Notes that the input tried to set `key`, so that a wrong value is not reported as a missing
    /// one too.
    void mention(std::string_view key) { mentioned_.emplace_back(key); }
    bool is_mentioned(std::string_view key) const;

private:
    std::vector<Setting> settings_;
    std::vector<std::string> mentioned_;
};

inline void add_problem(Problems& problems, const Place& place, std::string text) {
    problems.push_back({place.name, place.line, std::move(text)});
}

} // namespace carrom
