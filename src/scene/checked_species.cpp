// SPDX-License-Identifier: BSD-3-Clause
#include "scene/checked_species.hpp"

#include <algorithm>

#include "scene/limits.hpp"

namespace carrom {

namespace {

/// What is wrong with a body, or empty.
std::string body_problem(double radius, double mass) {
    const std::string text = column_problem(DiscColumn::radius, radius);
    return text.empty() ? column_problem(DiscColumn::mass, mass) : text;
}

/// Rows of `discs.list` are [x, y, vx, vy], then radius and mass, or the spin, or all three.
bool has_body(const Row& row) { return row.numbers.size() >= 6; }
bool has_spin(const Row& row) { return row.numbers.size() % 2 == 1; }

/// The list, if its rows name radii and masses.
const Setting* list_of_bodies(const Check& check) {
    const Setting* list = check.settings.find("discs.list");
    if (!list) return nullptr;
    const auto& rows = std::get<std::vector<Row>>(list->value);
    return std::any_of(rows.begin(), rows.end(), has_body) ? list : nullptr;
}

/// `discs.columns`, if radii are among them.
const Setting* column_of_radii(const Check& check) {
    return has_column(check.scene, DiscColumn::radius) ? check.settings.find("discs.columns")
                                                       : nullptr;
}

void fill_from_list(const Check& check, const Setting& list) {
    const auto& rows = std::get<std::vector<Row>>(list.value);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto& n = rows[i].numbers;
        const auto refuse = [&](const std::string& text) {
            add_problem(check.problems, rows[i].place,
                        fmt::format("row {} of 'discs.list': {}", i + 1, text));
        };
        if (n.empty()) continue; // a problem already
        if (!has_body(rows[i]))
            refuse("other rows have six numbers, [x, y, vx, vy, radius, mass]");
        else if (const std::string text = body_problem(n[4], n[5]); !text.empty())
            refuse(text);
        else
            add_species(check.scene.effects.species, {1, n[4], n[5]});
    }
}

void fill_from_table(const Check& check, const Setting& species) {
    for (const SpeciesRow& row : std::get<std::vector<SpeciesRow>>(species.value)) {
        const auto refuse = [&](const std::string& text) {
            add_problem(check.problems, row.place, fmt::format("class {}: {}", row.number, text));
        };
        if (!(row.count >= 1 && row.count <= static_cast<double>(largest_count)) ||
            row.count != std::floor(row.count))
            refuse(fmt::format("its count must be a whole number from 1 to {}, not {}",
                               largest_count, row.count));
        else if (const std::string text = body_problem(row.radius, row.mass); !text.empty())
            refuse(text);
        else
            add_species(check.scene.effects.species,
                        {static_cast<std::uint64_t>(row.count), row.radius, row.mass});
    }
    if (check.scene.effects.species.empty())
        check.refuse(species, "'discs.species' has no class that is right");
}

void fill_columns(const Check& check) {
    const Setting* setting = check.settings.find("discs.columns");
    if (!setting) return;
    static constexpr std::array<std::pair<std::string_view, DiscColumn>, 3> names = {
        {{"radius", DiscColumn::radius}, {"mass", DiscColumn::mass}, {"spin", DiscColumn::spin}}};
    auto& columns = check.scene.disc_columns;
    for (const std::string& word : std::get<std::vector<std::string>>(setting->value)) {
        const auto found = std::find_if(names.begin(), names.end(),
                                        [&word](const auto& name) { return name.first == word; });
        if (found == names.end())
            check.refuse(
                *setting,
                fmt::format("a column of discs is \"radius\", \"mass\" or \"spin\", not {}",
                            quoted(word)));
        else if (has_column(check.scene, found->second))
            check.refuse(*setting, fmt::format("'discs.columns' has \"{}\" twice", word));
        else
            columns.push_back(found->second);
    }
    if (!check.settings.has("discs.file"))
        check.refuse(*setting, "'discs.columns' has no meaning without 'discs.file'");
    if (has_column(check.scene, DiscColumn::mass) && !has_column(check.scene, DiscColumn::radius))
        check.refuse(*setting, "'discs.columns' with \"mass\" needs \"radius\", too");
}

} // namespace

const Setting* species_setting(const Check& check) {
    if (const Setting* species = check.settings.find("discs.species")) return species;
    const Setting* list = list_of_bodies(check);
    return list ? list : column_of_radii(check);
}

bool are_species_unknown(const Check& check) {
    return column_of_radii(check) && (!check.columns || !check.columns->is_whole);
}

void fill_species(const Check& check) {
    fill_columns(check);
    const Setting* species = check.settings.find("discs.species");
    const Setting* list = list_of_bodies(check);
    const Setting* columns = column_of_radii(check);
    const char* where = list      ? "the rows of 'discs.list' name radii"
                        : columns ? "'discs.columns' name radii"
                                  : "'discs.species' name radii";
    if (species && (list || columns))
        check.refuse(*species,
                     fmt::format("'discs.species' has no meaning where {}",
                                 list ? "the rows of 'discs.list' name radii and masses" : where));
    else if (species)
        fill_from_table(check, *species);
    else if (list)
        fill_from_list(check, *list);
    else if (columns && check.columns)
        check.scene.effects.species = check.columns->species;
    if (!species && !list && !columns) return;
    for (const std::string_view key : {"discs.radius", "discs.packing"})
        if (const Setting* setting = check.settings.find(key))
            check.refuse(*setting, fmt::format("'{}' has no meaning where {}", key, where));
}

void fill_first_spins(const Check& check) {
    constexpr std::string_view needed = "effects.contact.kind = \"rough\"";
    std::vector<SpinRun>& spins = check.scene.spins;
    const bool are_rough = check.scene.effects.contact.kind == ContactKind::rough;
    bool are_any = false;
    const auto add = [&](const Place& place, double count, double spin, bool is_given,
                         const std::string& what) {
        const std::string text = column_problem(DiscColumn::spin, spin);
        if (!text.empty())
            add_problem(check.problems, place, fmt::format("{}: {}", what, text));
        else if (is_given && !are_rough)
            add_problem(check.problems, place,
                        fmt::format("{}: a spin has no meaning without {}", what, needed));
        are_any = are_any || is_given;
        if (count >= 1 && count <= static_cast<double>(largest_count))
            add_spins(spins, static_cast<std::uint64_t>(count), spin);
    };
    if (const Setting* list = check.settings.find("discs.list")) {
        const auto& rows = std::get<std::vector<Row>>(list->value);
        for (std::size_t i = 0; i < rows.size(); ++i)
            add(rows[i].place, 1, has_spin(rows[i]) ? rows[i].numbers.back() : 0, has_spin(rows[i]),
                fmt::format("row {} of 'discs.list'", i + 1));
    } else if (const Setting* species = check.settings.find("discs.species")) {
        for (const SpeciesRow& row : std::get<std::vector<SpeciesRow>>(species->value))
            add(row.place, row.count, row.spin, row.spin != 0, fmt::format("class {}", row.number));
    }
    if (!are_any) spins.clear();
    if (check.columns) spins = check.columns->spins;
    if (has_column(check.scene, DiscColumn::spin) && !are_rough)
        check.refuse(*check.settings.find("discs.columns"),
                     fmt::format("spins have no meaning without {}", needed));
}

} // namespace carrom
