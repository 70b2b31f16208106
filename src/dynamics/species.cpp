// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/species.hpp"

namespace carrom {

namespace {

/// More species than this are not searched one by one.
constexpr std::size_t few_species = 8;

} // namespace

SpeciesTable::SpeciesTable(std::span<const Species> species, double radius) {
    auto table = std::make_shared<Table>();
    DiscId end = 0;
    for (const Species& one : species) {
        end += one.count;
        table->ranges.push_back({end, {one.radius, one.mass}});
        if (species.size() > few_species)
            table->by_id.insert(table->by_id.end(), one.count, SizeAndMass{one.radius, one.mass});
    }
    table->ranges.push_back(
        {std::numeric_limits<DiscId>::max(),
         species.empty() ? SizeAndMass{radius, 1} : table->ranges.back().values});
    if (!species.empty()) table->ranges.erase(table->ranges.end() - 2); // the last one has no end
    ranges_ = table->ranges.data();
    by_id_ = table->by_id.empty() ? nullptr : table->by_id.data();
    table_ = std::move(table);
}

} // namespace carrom
