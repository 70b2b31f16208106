// SPDX-License-Identifier: BSD-3-Clause
#include "scene/checked_measurements.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "scene/limits.hpp"

namespace carrom {

namespace {

constexpr const char* distance_key = "output.measurements.largest_distance";

/// Tables that grow with time are kept in memory and in checkpoints.
constexpr std::int64_t most_samples_of_histories = 100000;

void fill_quantities(const Check& check, MeasurementOutput& output) {
    constexpr std::string_view key = "output.measurements.quantities";
    const std::array<std::pair<std::string_view, bool*>, 5> known = {
        {{"wall_pressure", &output.wall_pressure},
         {"radial_distribution", &output.radial_distribution},
         {"velocities", &output.velocities},
         {"density", &output.density},
         {"displacement", &output.displacement}}};
    check.refuse_missing(key, "a list of \"wall_pressure\", \"radial_distribution\", "
                              "\"velocities\", \"density\", \"displacement\"");
    const Setting* setting = check.settings.find(key);
    if (!setting) return;
    const auto& words = std::get<std::vector<std::string>>(setting->value);
    if (words.empty())
        check.refuse(
            *setting,
            fmt::format("'{}' is empty; name what is to be measured, or leave the table out", key));
    std::array<std::string_view, known.size()> names;
    std::string list;
    for (std::size_t i = 0; i < known.size(); ++i) {
        names[i] = known[i].first;
        list += (i == 0 ? "" : i + 1 == known.size() ? " or " : ", ") + quoted(names[i]);
    }
    for (const std::string& word : words) {
        const auto found = std::find(names.begin(), names.end(), word);
        if (found == names.end())
            check.refuse(*setting, fmt::format("what is measured is {}, not {}{}", list,
                                               quoted(word), guess(word, names, '"')));
        else
            *known[static_cast<std::size_t>(found - names.begin())].second = true;
    }
}

void refuse_unless(const Check& check, bool is_asked_for, const char* key, const char* quantities) {
    const Setting* setting = check.settings.find(key);
    if (setting && !is_asked_for)
        check.refuse(
            *setting,
            fmt::format("'{}' has no meaning without {} among 'output.measurements.quantities'",
                        key, quantities));
}

double positive(const Check& check, const char* key, double number) {
    if (!(number > 0))
        check.refuse(*check.settings.find(key),
                     fmt::format("'{}' must be greater than 0, not {}", key, number));
    return number;
}

} // namespace

void fill_measurements(const Check& check) {
    if (!has_table(check, "output.measurements")) return;
    MeasurementOutput& output = check.scene.measurements.emplace();
    output.folder = check.scene.folder + "/measurements";
    fill_quantities(check, output);
    if (const auto every = whole_number(check, "output.measurements.every_steps", 1, largest_steps))
        output.every_steps = *every;
    if (const auto from = whole_number(check, "output.measurements.from_step", 0, largest_steps))
        output.from_step = *from;
    if (const auto bins = whole_number(check, "output.measurements.bins", 1, 10000))
        output.bins = static_cast<std::size_t>(*bins);
    if (const auto velocity = finite_number(check, "output.measurements.largest_velocity"))
        output.largest_velocity = positive(check, "output.measurements.largest_velocity",
                                           *velocity);
    if (const auto distance = finite_number(check, distance_key))
        output.largest_distance = positive(check, distance_key, *distance);
    refuse_unless(check, output.radial_distribution, distance_key, "\"radial_distribution\"");
    refuse_unless(check, output.velocities, "output.measurements.largest_velocity",
                  "\"velocities\"");
    refuse_unless(check, output.radial_distribution || output.velocities || output.density,
                  "output.measurements.bins",
                  "\"radial_distribution\", \"velocities\" or \"density\"");
    const std::int64_t n_samples = (check.scene.steps - output.from_step) / output.every_steps;
    if ((output.wall_pressure || output.displacement) && n_samples > most_samples_of_histories) {
        const Setting* setting = check.settings.find("output.measurements.every_steps");
        if (!setting) setting = check.settings.find("output.measurements.quantities");
        if (setting)
            check.refuse(
                *setting,
                fmt::format("{} samples of \"wall_pressure\" or \"displacement\" are more than {}; "
                            "take output.measurements.every_steps = {}",
                            n_samples, most_samples_of_histories,
                            (check.scene.steps - output.from_step) / most_samples_of_histories +
                                1));
    }
}

void check_measured_box(const Check& check) {
    Scene& scene = check.scene;
    const bool goes_round_x = scene.effects.is_periodic_x(),
               goes_round_y = scene.effects.is_periodic_y();
    if (const Setting* setting = check.settings.find("output.measurements.quantities");
        setting && scene.measurements && scene.measurements->wall_pressure && goes_round_x &&
        goes_round_y)
        check.refuse(
            *setting,
            "there is no \"wall_pressure\" in a box without walls: all of its sides are periodic");
    const bool is_about_all = scene.measurements && (scene.measurements->wall_pressure ||
                                                     scene.measurements->radial_distribution ||
                                                     scene.measurements->displacement);
    if (const Setting* setting = check.settings.find("output.measurements.quantities");
        setting && scene.effects.have_open_boundaries() && is_about_all)
        check.refuse(
            *setting,
            "in boxes with open sides this version measures \"velocities\" and \"density\" alone");
    if (!scene.measurements || !scene.measurements->radial_distribution) return;
    // Walls may come in; the box is the smallest at its start or at its end.
    const Extent end = extent_at(scene.effects, scene.box_size, static_cast<double>(scene.steps));
    const double wide = std::min(scene.box_size, end.x_high - end.x_low),
                 high = std::min(scene.box_size, end.y_high - end.y_low);
    const double largest = std::min(wide - (goes_round_x ? 0 : 2 * scene.radius),
                                    high - (goes_round_y ? 0 : 2 * scene.radius)) /
                           2;
    double& distance = scene.measurements->largest_distance;
    const Setting* setting = check.settings.find(distance_key);
    scene.measurements->is_distance_default = !setting;
    if (!setting) distance = std::min(10 * scene.radius, largest);
    if (const Setting* quantities = check.settings.find("output.measurements.quantities");
        quantities && !scene.effects.species.empty() && !(goes_round_x && goes_round_y))
        check.refuse(*quantities,
                     "between walls centres of large discs have less room than those of small "
                     "ones: the radial distribution of discs of several classes "
                     "needs a box that is periodic all round");
    if (distance <= largest && distance > 0) return;
    if (!setting) setting = check.settings.find("output.measurements.quantities");
    if (setting)
        check.refuse(*setting, fmt::format("the radial distribution cannot reach {:g}: half the "
                                           "width of the box that centres of discs have is {:g}",
                                           distance, largest));
}

} // namespace carrom
