// SPDX-License-Identifier: BSD-3-Clause
// What a quantity of [output.measurements] declares about itself: its keys, what it does not go
// with, its checks, and its text for the pages. The code that measures it lies further up, in
// src/measure, and so do the declarations. A program that measures hands them down as it starts.
// The reader, the pages and the checks go through the list, so they name no quantity.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/check.hpp"
#include "scene/key.hpp"

namespace carrom {

struct Quantity {
    std::string_view name;
    std::string_view help;            ///< for the page of keys
    std::vector<Key> keys = {};       ///< settings that it needs; quantities can share one
    bool has_history = false;         ///< its tables grow with each sample
    std::vector<Rule> rules = {};     ///< what it does not go with
    void (*check)(const Check&) = {}; ///< with a right box and right discs; shared ones run once
    void (*check_times)(const Check&) = {}; ///< once the times of the scene are known
};

/// To be called once, before any scene is read.
void declare_quantities(std::vector<Quantity> quantities);

const std::vector<Quantity>& declared_quantities();

/// The key of which quantities are measured: a problem with a setting that is not given stands
/// there.
inline constexpr std::string_view quantities_key = "output.measurements.quantities";

inline bool measures(const Scene& scene, std::string_view quantity) {
    return scene.measurements && scene.measurements->measures(quantity);
}

/// A number that quantities share or have for themselves: `output.measurements.NAME`.
struct QuantitySetting {
    std::string_view name;
    double fallback = 0;

    double of(const MeasurementOutput& output) const {
        const auto found = output.settings.find(name);
        return found == output.settings.end() ? fallback : found->second.value;
    }
    std::string key_name() const { return "output.measurements." + std::string(name); }
    /// Its key; `by_default` says in words what a check works out, if there is no fixed default.
    Key number(std::string_view unit, std::string_view help,
               std::string_view by_default = "") const;
    Key integer(std::string_view unit, std::string_view help,
                std::string_view by_default = "") const;
};

/// The declared keys, and what each has no meaning without.
std::vector<Key> keys_of_quantities();
std::vector<Rule> rules_of_quantities();

/// Runs those of the quantities that the scene measures.
void check_quantities(const Check& check);
void check_times_of_quantities(const Check& check);

} // namespace carrom
