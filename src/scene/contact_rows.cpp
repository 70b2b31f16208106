// SPDX-License-Identifier: BSD-3-Clause
#include "scene/contact_rows.hpp"

#include <cmath>

#include "scene/species_rows.hpp"

namespace carrom {

namespace {

struct ContactLimits {
    std::string_view name;
    double low, high;
};

constexpr ContactLimits all_limits[] = {
    {"restitution", 0, 1}, {"tangential_restitution", -1, 1}, {"friction", 0, 1e6}};

} // namespace

std::vector<Field> contact_fields() {
    std::vector<Field> fields;
    for (const ContactLimits& one : all_limits) fields.push_back({one.name, "", 1, 1, not_given});
    return fields;
}

std::optional<std::size_t> count_species_rows(const SceneDraft& draft) {
    const Setting* species = draft.settings.find("discs.species");
    const auto* rows = species ? std::get_if<Values>(&species->value.data) : nullptr;
    if (!rows) return std::nullopt;
    return rows->size();
}

bool is_species_row(double number, std::size_t n_rows) {
    return number >= 1 && number <= static_cast<double>(n_rows) && number == std::floor(number);
}

std::string problem_of_contact_numbers(const Numbers& row, std::size_t begin,
                                       std::string_view why_smooth) {
    bool is_any = false;
    std::size_t next = begin;
    for (const ContactLimits& one : all_limits) {
        const std::size_t place = next++;
        if (!is_given(row, place)) continue;
        is_any = true;
        if (!why_smooth.empty() && one.name != "restitution")
            return fmt::format("{} has no meaning without {}", one.name, why_smooth);
        if (!(row[place] >= one.low && row[place] <= one.high))
            return fmt::format("its {} must be from {} to {}, not {}", one.name, one.low, one.high,
                               row[place]);
    }
    constexpr std::size_t tangential = 1, friction = 2;
    if (is_any && is_given(row, begin + friction) && row[begin + tangential] == -1)
        return "friction has no meaning with tangential_restitution = -1";
    if (is_any) return {};
    return "it gives no number; it takes restitution, and friction and tangential_restitution of "
           "surfaces that rub";
}

} // namespace carrom
