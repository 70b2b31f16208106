// SPDX-License-Identifier: BSD-3-Clause
#include "scene/places.hpp"

#include <algorithm>
#include <cctype>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scene/number.hpp"

namespace carrom {

namespace {

/// The axis that a name such as "x", "y" or "x0" stands for.
std::optional<Axis> axis_of_name(std::string_view name) {
    if (name.empty() || (name[0] != 'x' && name[0] != 'y')) return std::nullopt;
    const bool is_place = std::ranges::all_of(name.substr(1),
                                              [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!is_place) return std::nullopt;
    return name[0] == 'x' ? Axis::x : Axis::y;
}

/// The axis of each of the `n` numbers in a form such as "[x, y, radius]". If `form` contains
/// several forms, the last one is used, which is the longest.
std::vector<std::optional<Axis>> axes_of(std::string_view form, std::size_t n) {
    std::vector<std::optional<Axis>> axes;
    bool goes_on = false;
    form.remove_prefix(std::min(form.rfind('['), form.size()));
    while (!form.empty() && axes.size() < n) {
        form.remove_prefix(std::min(form.find_first_not_of("[, "), form.size()));
        const std::string_view name = form.substr(0, form.find_first_of(",]"));
        form.remove_prefix(name.size());
        goes_on = name == "...";
        if (goes_on) break;
        axes.push_back(axis_of_name(name));
        if (form.starts_with(']')) break;
    }
    while (goes_on && axes.size() >= 2 && axes.size() < n) axes.push_back(axes[axes.size() - 2]);
    axes.resize(n);
    return axes;
}

std::vector<std::optional<Axis>> axes_of(const Key& key) {
    std::vector<std::optional<Axis>> all;
    for (const Field& field : key.fields)
        for (const std::optional<Axis> axis : axes_of(field.form, field.most)) all.push_back(axis);
    if (!key.has_rows()) all = {key.axis};
    return all;
}

void move_row(const std::vector<std::optional<Axis>>& axes, Numbers& row, double dx, double dy) {
    for (std::size_t k = 0; k < std::min(row.size(), axes.size()); ++k)
        if (axes[k]) row[k] += along(*axes[k], dx, dy);
}

} // namespace

std::optional<Axis> axis_of(const Key& key, std::size_t number) {
    const std::vector<std::optional<Axis>> axes = axes_of(key);
    return number < axes.size() ? axes[number] : std::nullopt;
}

bool has_places(const Key& key) {
    return std::ranges::any_of(axes_of(key), [](const auto& axis) { return axis.has_value(); });
}

void move_places(const Key& key, Value& value, double dx, double dy) {
    const std::vector<std::optional<Axis>> axes = axes_of(key);
    if (auto* const number = std::get_if<double>(&value.data); number && axes.front())
        *number += along(*axes.front(), dx, dy);
    if (auto* const rows = std::get_if<Values>(&value.data))
        for (Value& row : *rows)
            if (auto* const numbers = std::get_if<Numbers>(&row.data))
                move_row(axes, *numbers, dx, dy);
}

void find_origin(SceneParameters& scene) {
    if (!scene.origin.is_centre) return;
    scene.origin.x = scene.box.x / 2;
    scene.origin.y = scene.box.y / 2;
}

std::string shown_coordinate(double place, double origin) {
    const double exact = place - origin;
    for (int digits = 1; digits < 17 && origin != 0; ++digits) {
        const auto rounded = parse_double(fmt::format("{:.{}g}", exact, digits));
        if (rounded && *rounded + origin == place) return fmt::format("{}", *rounded);
    }
    return fmt::format("{}", exact);
}

std::string shown_place(const SceneParameters& scene, double x, double y) {
    return fmt::format("({}, {})", shown_coordinate(x, scene.origin.x),
                       shown_coordinate(y, scene.origin.y));
}

std::string corner_text(const SceneParameters& scene) {
    if (!scene.origin.is_on()) return "";
    return ", whose lower left corner is at " + shown_place(scene, 0, 0);
}

} // namespace carrom
