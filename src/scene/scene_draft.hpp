// SPDX-License-Identifier: BSD-3-Clause
// A scene that is being read: as far as it is known, with the settings that it comes from and the
// problems that its checks have found. All problems are reported at once, so checks go on after
// one.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scene/disc_columns.hpp"
#include "scene/key.hpp"
#include "scene/settings.hpp"

namespace carrom {

/// The key that rules and checks of measurements name.
inline constexpr std::string_view quantities = "output.measurements.quantities";

struct SceneDraft {
    SceneParameters& scene;
    Settings& settings;
    Problems& problems;
    const DiscColumns* columns = nullptr; ///< in the file of discs

    /// A problem at the first of these keys that the input has, or else of the scene as a whole.
    template <class Keys> void refuse_first(const Keys& keys, std::string text) const {
        Place place{scene.name, 0};
        for (const std::string_view key : keys) {
            if (!settings.has(key)) continue;
            place = settings.find(key)->place;
            break;
        }
        add_problem(problems, place, std::move(text));
    }
    void refuse(std::initializer_list<std::string_view> keys, std::string text) const {
        refuse_first(keys, std::move(text));
    }
    /// Whether the scene has the time between syncs that was set, or the default. A wrong one is a
    /// problem already, and the scene has the default then.
    bool knows_syncs() const {
        const Setting* every = settings.find("time.sync_every");
        return !every || !every->is_wrong;
    }
    /// Calls what(row, its number from 1, its place) for the valid rows of a list.
    template <class What> void for_each_row(std::string_view key, const What& what) const {
        const Setting* setting = settings.find(key);
        if (!setting || !std::holds_alternative<Values>(setting->value.data)) return;
        std::size_t number = 0;
        for (const Value& row : std::get<Values>(setting->value.data)) {
            ++number;
            if (const auto* numbers = std::get_if<Numbers>(&row.data))
                what(*numbers, number, Place{setting->place.name, row.line});
        }
    }
    /// Adds "row 2 of 'key': ..." for the first rows for which fault(row) is not empty, and the
    /// number of the others.
    template <class Fault> void refuse_rows(std::string_view key, const Fault& fault) const {
        constexpr std::size_t most_listed = 20;
        std::size_t n_wrong = 0;
        for_each_row(key, [&](const Numbers& row, std::size_t number, const Place& place) {
            const std::string text = fault(row, number - 1);
            if (!text.empty() && ++n_wrong <= most_listed)
                add_problem(problems, place, fmt::format("row {} of '{}': {}", number, key, text));
        });
        if (n_wrong > most_listed)
            refuse({key},
                   fmt::format("and {} more wrong rows of '{}'", n_wrong - most_listed, key));
    }
};

inline double steps_between_syncs(const SceneParameters& scene) {
    return static_cast<double>(scene.sync_every) / static_cast<double>(scene.micro_steps);
}

/// Checks the number, sizes, places and speeds of discs. Returns false if box or discs
/// are not known to be right; then both sizes are 0.
bool check_discs(const SceneDraft& draft);

/// Refuses conditions of `[time.stop]` on what the scene's discs do not have.
void check_stop(const SceneDraft& draft);
/// Reports what the scene has and a GPU cannot do, if one is asked for.
void check_gpu(const SceneDraft& draft);

/// Checks whether `discs.columns` can be those of lines of discs.
void check_columns(const SceneDraft& draft);
/// Checks the lengths of the rows of `discs.list`. Places alone need velocities that are drawn.
void check_rows_of_list(const SceneDraft& draft);

/// Checks numbers of steps, rates and times against each other.
void check_times(const SceneDraft& draft);

/// A contact time that the scene does not set becomes `longest` steps at most; a longer one is a
/// problem, with `why` as the reason.
void limit_contact_time(const SceneDraft& draft, double longest, std::string_view why);

} // namespace carrom
