// SPDX-License-Identifier: BSD-3-Clause
#include "checked_classes.hpp"

#include "limits.hpp"

namespace carrom {

namespace {

constexpr double smallest_mass = 0x1p-100, largest_mass = 0x1p100;

/// What is wrong with a body, or empty.
std::string body_problem(double radius, double mass) {
    if (!(radius >= smallest_length && radius <= largest_size)) return fmt::format("the radius must be from 2^-230 to 2^250, not {}", radius);
    if (!(mass >= smallest_mass && mass <= largest_mass)) return fmt::format("the mass must be from 2^-100 to 2^100, not {}", mass);
    return {};
}

/// The list, if its rows name radii and masses.
const Setting* list_of_bodies(const Check& check) {
    const Setting* list = check.settings.find("discs.list");
    if (!list) return nullptr;
    for (const Row& row : std::get<std::vector<Row>>(list->value))
        if (row.numbers.size() == 6) return list;
    return nullptr;
}

void add_class(std::vector<DiscClass>& classes, const DiscClass& next) {
    if (!classes.empty() && classes.back().radius == next.radius && classes.back().mass == next.mass) classes.back().count += next.count;
    else classes.push_back(next);
}

void fill_from_list(const Check& check, const Setting& list) {
    const auto& rows = std::get<std::vector<Row>>(list.value);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto& n = rows[i].numbers;
        const auto refuse = [&](const std::string& text) { add_problem(check.problems, rows[i].place, fmt::format("row {} of 'discs.list': {}", i + 1, text)); };
        if (n.empty()) continue; // a problem already
        if (n.size() != 6) refuse("other rows have six numbers, [x, y, vx, vy, radius, mass]");
        else if (const std::string text = body_problem(n[4], n[5]); !text.empty()) refuse(text);
        else add_class(check.scene.effects.classes, {1, n[4], n[5]});
    }
}

void fill_from_table(const Check& check, const Setting& classes) {
    for (const ClassRow& row : std::get<std::vector<ClassRow>>(classes.value)) {
        const auto refuse = [&](const std::string& text) { add_problem(check.problems, row.place, fmt::format("class {}: {}", row.number, text)); };
        if (!(row.count >= 1 && row.count <= static_cast<double>(largest_count)) || row.count != std::floor(row.count))
            refuse(fmt::format("its count must be a whole number from 1 to {}, not {}", largest_count, row.count));
        else if (const std::string text = body_problem(row.radius, row.mass); !text.empty()) refuse(text);
        else add_class(check.scene.effects.classes, {static_cast<std::uint64_t>(row.count), row.radius, row.mass});
    }
    if (check.scene.effects.classes.empty()) check.refuse(classes, "'discs.classes' has no class that is right");
}

} // namespace

const Setting* classes_setting(const Check& check) {
    const Setting* classes = check.settings.find("discs.classes");
    return classes ? classes : list_of_bodies(check);
}

void fill_classes(const Check& check) {
    const Setting* classes = check.settings.find("discs.classes");
    const Setting* list = list_of_bodies(check);
    if (classes && list) check.refuse(*classes, "'discs.classes' has no meaning where the rows of 'discs.list' name radii and masses");
    else if (classes) fill_from_table(check, *classes);
    else if (list) fill_from_list(check, *list);
    else return;
    for (const std::string_view key : {"discs.radius", "discs.packing"})
        if (const Setting* setting = check.settings.find(key))
            check.refuse(*setting, fmt::format("'{}' has no meaning where {}", key, list ? "the rows of 'discs.list' name radii" : "'discs.classes' name radii"));
}

} // namespace carrom
