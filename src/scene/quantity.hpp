// SPDX-License-Identifier: BSD-3-Clause
// The declaration of a quantity of [output.measurements]: its keys, rules of conflict, checks, and
// text for the pages. The declarations are in a higher module, src/measure, with the code that
// measures. A program that measures stores the declarations here when it starts. The reader, the
// pages and the general checks loop over the list, so they need not name any quantity.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

struct Quantity {
    std::string_view name;
    std::string_view help;            ///< the quantity's text on the page of keys
    bool needs_lasting_sides = false; ///< whether its table needs sides of constant lengths
    std::vector<Key> keys = {}; ///< settings of the quantity; several quantities can share one
    bool has_history = false;   ///< whether its tables grow with each sample
    bool follows_collisions =
        false;                    ///< whether it needs a record of each collision; GPUs have none
    std::vector<Rule> rules = {}; ///< features with which it cannot be combined
    void (*check)(const SceneDraft&) = {}; ///< called if box and discs are valid; runs once even
                                           ///< if several measured quantities have this check
    void (*check_times)(const SceneDraft&) = {}; ///< called when the times of the scene are known
};

/// Stores the declarations. Call it once, before any scene is read.
void declare_quantities(std::vector<Quantity> quantities);

const std::vector<Quantity>& declared_quantities();

/// The key that lists the quantities to measure. Problems of a quantity are reported at this key if
/// the scene does not contain the quantity's own keys.
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
    /// The key of this number. `by_default` describes the default if a check computes it.
    Key number(std::string_view unit, std::string_view help,
               std::string_view by_default = "") const;
    Key integer(std::string_view unit, std::string_view help,
                std::string_view by_default = "") const;
};

/// The keys of all quantities. Each has a meaning only if a quantity that uses it is measured.
std::vector<Key> keys_of_quantities();
std::vector<Rule> rules_of_quantities();

/// Runs the checks of the quantities that the scene measures.
void check_quantities(const SceneDraft& draft);
void check_times_of_quantities(const SceneDraft& draft);

} // namespace carrom
