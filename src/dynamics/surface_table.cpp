// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/surface_table.hpp"

#include <algorithm>
#include <cmath>

namespace carrom {

namespace {

double number_of(double given, double common) { return std::isnan(given) ? common : given; }

SurfaceTable::Factors factors_of(const SurfaceNumbers& numbers, const ContactEffect& contact) {
    return {numbers.restitution, Rubbing(numbers.surface, contact)};
}

} // namespace

SurfaceNumbers common_numbers(const Effects& effects, std::size_t surface) {
    if (surface == SurfaceContacts::fixed_bodies)
        return {effects.fixed_bodies.restitution, effects.fixed_bodies.surface};
    const Boundary& side = effects.boundaries[surface];
    return {side.restitution, side.surface};
}

SurfaceNumbers numbers_of(const Effects& effects, std::size_t surface, const SurfaceContact& row) {
    SurfaceNumbers all = common_numbers(effects, surface);
    all.restitution = number_of(row.restitution, all.restitution);
    all.surface.tangential_restitution = number_of(row.tangential_restitution,
                                                   all.surface.tangential_restitution);
    all.surface.friction = number_of(row.friction, all.surface.friction);
    return all;
}

bool does_rub(const Effects& effects, std::size_t surface) {
    return common_numbers(effects, surface).rubs() ||
           std::ranges::any_of(
               effects.surface_contacts.rows[surface],
               [&](const SurfaceContact& row) { return numbers_of(effects, surface, row).rubs(); });
}

/// Species whose discs are all frozen have no ids, so their rows are never used.
SurfaceTable::SurfaceTable(const Effects& effects, std::size_t surface)
    : common_(factors_of(common_numbers(effects, surface), effects.contact)) {
    const std::vector<SurfaceContact>& named = effects.surface_contacts.rows[surface];
    if (named.empty() || effects.contact.rows.empty()) return;
    std::vector<Row> rows;
    for (const SpeciesRow& one : effects.contact.rows) {
        const auto found = std::ranges::find(named, static_cast<double>(one.row + 1),
                                             &SurfaceContact::species);
        rows.push_back(
            {one.end, found == named.end()
                          ? common_
                          : factors_of(numbers_of(effects, surface, *found), effects.contact)});
    }
    rows_ = std::make_shared<const std::vector<Row>>(std::move(rows));
}

} // namespace carrom
