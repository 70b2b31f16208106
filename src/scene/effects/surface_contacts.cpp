// SPDX-License-Identifier: BSD-3-Clause
// Contacts with sides and obstacles that depend on the species of the disc
// (dynamics/surface_table.hpp).
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "dynamics/surface_table.hpp"
#include "scene/boundaries/boundary.hpp"
#include "scene/contact_rows.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/rule_parts.hpp"
#include "scene/species_rows.hpp"

namespace carrom {

namespace {

/// The indices of the numbers in a row of a surface's `contacts`.
constexpr std::size_t of_species = 0, of_restitution = 1, of_tangential = 2;

std::string table_of_surface(std::size_t surface) {
    return surface == SurfaceContacts::fixed_bodies
               ? "effects.obstacles"
               : fmt::format("box.{}", boundary_names[surface]);
}

std::string contacts_key(std::size_t surface) { return table_of_surface(surface) + ".contacts"; }

std::string name_of_surface(std::size_t surface) {
    return surface == SurfaceContacts::fixed_bodies
               ? std::string("obstacles")
               : fmt::format("the {} wall", boundary_names[surface]);
}

bool can_reflect(const SceneParameters& s, std::size_t surface) {
    if (surface == SurfaceContacts::fixed_bodies) return has_fixed_bodies(s);
    const BoundaryKind kind = s.effects.boundaries[surface].kind;
    return kind == BoundaryKind::wall || kind == BoundaryKind::moving ||
           kind == BoundaryKind::oscillating;
}

Need species_and(std::size_t surface) {
    const std::string other = surface == SurfaceContacts::fixed_bodies
                                  ? "obstacles"
                                  : table_of_surface(surface) +
                                        ".kind = \"wall\", \"moving\" or \"oscillating\"";
    return {"without 'discs.species' and " + other, [surface](const SceneParameters& s) {
                return can_reflect(s, surface) && !s.effects.contact.rows.empty();
            }};
}

std::vector<Key> keys_of_surface_contacts() {
    std::vector<Field> fields = {{"species", ""}};
    for (const Field& one : contact_fields()) fields.push_back(one);
    std::vector<Key> all;
    for (std::size_t k = 0; k < SurfaceContacts::n_surfaces; ++k) {
        all.push_back(
            key(contacts_key(k), "1, 1, 1, 1",
                "Other numbers for discs of a row of 'discs.species', counted from 1. Numbers that "
                "a row leaves out are those of all discs.",
                [k](auto& s) -> auto& { return s.effects.surface_contacts.rows[k]; })
                .by_default("none")
                .needs(species_and(k))
                .with_rows(fields));
        all.back().compare = [k](const SceneParameters& a, const SceneParameters& b) {
            return a.effects.surface_contacts.rows[k] == b.effects.surface_contacts.rows[k];
        };
    }
    return all;
}

/// The setting that a row's friction needs and the scene lacks; empty if it lacks none.
std::string why_smooth(const SceneParameters& scene, std::size_t surface, const Numbers& row) {
    const double common = common_numbers(scene.effects, surface).surface.tangential_restitution;
    return is_given(row, of_tangential) || common != -1 ? "" : "a tangential_restitution above -1";
}

void check_contacts_of(const SceneDraft& draft, std::size_t surface) {
    const std::string key = contacts_key(surface);
    const std::optional<std::size_t> n_rows = count_species_rows(draft);
    if (!n_rows || !draft.settings.has(key)) return;
    std::map<double, std::size_t> known;
    draft.refuse_rows(key, [&](const Numbers& row, std::size_t k) {
        if (!is_species_row(row[of_species], *n_rows))
            return fmt::format("its species must be a row of 'discs.species', from 1 to {}, not {}",
                               *n_rows, row[of_species]);
        const std::string text = problem_of_contact_numbers(row, of_restitution,
                                                            why_smooth(draft.scene, surface, row));
        if (!text.empty()) return text;
        const auto [found, is_new] = known.emplace(row[of_species], k + 1);
        return is_new ? "" : fmt::format("row {} has this species already", found->second);
    });
}

void check_surface_contacts(const SceneDraft& draft) {
    for (std::size_t k = 0; k < SurfaceContacts::n_surfaces; ++k) check_contacts_of(draft, k);
}

std::string summary_of_surface_contacts(const Effects& effects) {
    std::string all;
    for (std::size_t k = 0; k < SurfaceContacts::n_surfaces; ++k)
        if (const std::size_t n = effects.surface_contacts.rows[k].size(); n > 0)
            all += fmt::format("{}{} of other numbers for {} species", all.empty() ? "" : "; ",
                               name_of_surface(k), n);
    return all;
}

/// Whether `holds(numbers)` is true for at least one row of any surface.
template <class What> bool is_any_row(const Effects& effects, const What& holds) {
    for (std::size_t k = 0; k < SurfaceContacts::n_surfaces; ++k)
        for (const SurfaceContact& row : effects.surface_contacts.rows[k])
            if (holds(numbers_of(effects, k, row))) return true;
    return false;
}

bool are_rows_lossy(const Effects& effects) {
    return is_any_row(effects, [](const SurfaceNumbers& numbers) { return numbers.is_lossy(); });
}

CheckAllowance allowance_of_surface_contacts(const Effects& effects) {
    CheckAllowance allowance;
    allowance.collisions_take_energy = is_any_row(effects, [](const SurfaceNumbers& numbers) {
        const bool sticks_without_loss = numbers.surface.tangential_restitution == 1 &&
                                         std::isinf(numbers.surface.friction);
        return numbers.is_lossy() || (numbers.rubs() && !sticks_without_loss);
    });
    return allowance;
}

} // namespace

namespace effects {

EffectDeclaration surface_contacts() {
    return {.keys = keys_of_surface_contacts(),
            .check_room = check_surface_contacts,
            .summary = summary_of_surface_contacts,
            .allowance = allowance_of_surface_contacts,
            .lets_discs_rest = are_rows_lossy};
}

} // namespace effects

} // namespace carrom
