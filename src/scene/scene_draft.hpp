// SPDX-License-Identifier: BSD-3-Clause
// A scene that is being read: its values, its settings, and the problems so far. All problems
// are reported together, so checks continue after the first problem.
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

/// The key at which rules and checks report problems of measurements.
inline constexpr std::string_view quantities = "output.measurements.quantities";

struct SceneDraft {
    SceneParameters& scene;
    Settings& settings;
    Problems& problems;
    const DiscColumns* columns = nullptr; ///< columns of the file of discs; null if not read

    /// Adds a problem at the first of these keys that the input has, or at the whole scene.
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
    /// Whether the scene's time between syncs is valid. If the given time is wrong, this is
    /// reported, and the scene has the default.
    bool knows_syncs() const {
        const Setting* every = settings.find("time.sync_every");
        return !every || !every->is_wrong;
    }
    /// Calls what(row, number, place) for the valid rows of a list; the first row has number 1.
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
    /// Adds the problem "row 2 of 'key': ..." for the first rows for which fault(row, index) is not
    /// empty, and the number of further such rows. The first row has index 0.
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

/// Checks the number, sizes, positions and speeds of discs. Returns false if box or radii may be
/// wrong, or if only a file that has not been read yet gives the number of discs.
bool check_discs(const SceneDraft& draft);

/// Reports conditions of `[time.stop]` on kT or pressure if these are undefined in the scene.
void check_stop(const SceneDraft& draft);
/// Reports features of the scene that a GPU cannot run, if the scene requires one.
void check_gpu(const SceneDraft& draft);

/// Checks that `discs.columns` names x with y, vx with vy, and velocities unless they are drawn.
void check_columns(const SceneDraft& draft);
/// Checks the lengths of the rows of `discs.list`. If rows contain only positions, velocities must
/// be drawn.
void check_rows_of_list(const SceneDraft& draft);

/// Checks numbers of steps, of micro-steps and of samples against each other.
void check_times(const SceneDraft& draft);

/// Reports a contact time of more than `longest` steps, if discs may come to rest and so need a
/// contact time. `why` describes `longest` in the message.
void limit_contact_time(const SceneDraft& draft, double longest, std::string_view why);

} // namespace carrom
