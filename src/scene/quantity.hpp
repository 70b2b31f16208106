// SPDX-License-Identifier: BSD-3-Clause
// What a quantity of [output.measurements] declares: its keys, what it does not go with, its
// checks, and its text for the pages. The code that measures it is in a higher module,
// src/measure, with its declaration. A program that measures passes the declarations down when
// it starts. The reader, the pages and the checks loop over the list, so they name no quantity.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

struct Quantity {
    std::string_view name;
    std::string_view help;           ///< for the page of keys
    std::vector<Key> keys = {};      ///< its settings; quantities can share one
    bool has_history = false;        ///< its tables grow with each sample
    bool follows_collisions = false; ///< one by one; a GPU lists none
    std::vector<Rule> rules = {};    ///< features that it does not go with
    void (*check)(
        const SceneDraft&) = {}; ///< for a valid box and valid discs; shared ones run once
    void (*check_times)(const SceneDraft&) = {}; ///< after the times of the scene are known
};

/// To be called once, before any scene is read.
void declare_quantities(std::vector<Quantity> quantities);

const std::vector<Quantity>& declared_quantities();

/// The key of the quantities to measure. Problems of settings that are not given are
/// reported at it.
inline constexpr std::string_view quantities_key = "output.measurements.quantities";

inline bool measures(const SceneParameters& scene, std::string_view quantity) {
    return scene.measurements && scene.measurements->measures(quantity);
}

/// A number that one or more quantities use: `output.measurements.NAME`.
struct QuantitySetting {
    std::string_view name;
    double fallback = 0;

    double of(const MeasurementOutput& output) const {
        const auto found = output.settings.find(name);
        return found == output.settings.end() ? fallback : found->second.value;
    }
    std::string key_name() const { return "output.measurements." + std::string(name); }
    /// Its key. `by_default` describes the default if a check computes it.
    Key number(std::string_view unit, std::string_view help,
               std::string_view by_default = "") const;
    Key integer(std::string_view unit, std::string_view help,
                std::string_view by_default = "") const;
};

/// The declared keys, with the quantities that each needs.
std::vector<Key> keys_of_quantities();
std::vector<Rule> rules_of_quantities();

/// Runs the checks of the quantities that the scene measures.
void check_quantities(const SceneDraft& draft);
void check_times_of_quantities(const SceneDraft& draft);

} // namespace carrom
