// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/species.hpp"

namespace carrom {

namespace {

/// If there are more species than this, a table with an entry for each disc replaces comparisons.
constexpr std::size_t few_species = 8;

/// The largest number of species that 16 bits can number.
constexpr std::size_t most_numbers = std::numeric_limits<std::uint16_t>::max() + std::size_t{1};

} // namespace

void SpeciesTable::Table::spread(std::span<const Species> species, DiscId n_discs,
                                 bool radii_change) {
    const bool has_numbers = species.size() <= most_numbers && !radii_change;
    // Memory is reserved here, because a vector that grows may take up to twice the memory.
    sizes.reserve(has_numbers ? species.size() : n_discs);
    if (has_numbers) species_of_id.reserve(n_discs);
    for (const Species& one : species) {
        if (has_numbers)
            species_of_id.insert(species_of_id.end(), one.count,
                                 static_cast<std::uint16_t>(sizes.size()));
        sizes.insert(sizes.end(), has_numbers ? 1 : one.count, {one.radius, one.mass});
    }
}

SpeciesTable::SpeciesTable(std::span<const Species> species, double radius, bool radii_change)
    : table_(table_of(species, radius, radii_change)), view_(view_of(*table_)) {}

std::shared_ptr<SpeciesTable::Table> SpeciesTable::table_of(std::span<const Species> species,
                                                            double radius, bool radii_change) {
    auto table = std::make_shared<Table>();
    DiscId end = 0;
    for (const Species& one : species) {
        end += one.count;
        table->ranges.push_back({end, {one.radius, one.mass}});
    }
    table->ranges.push_back(
        {std::numeric_limits<DiscId>::max(),
         species.empty() ? SizeAndMass{radius, 1} : table->ranges.back().values});
    // The last species uses the range without an end.
    if (!species.empty()) table->ranges.erase(table->ranges.end() - 2);
    if (species.size() > few_species || radii_change) table->spread(species, end, radii_change);
    return table;
}

SpeciesView SpeciesTable::view_of(const Table& table) {
    return {table.ranges.data(), table.sizes.empty() ? nullptr : table.sizes.data(),
            table.species_of_id.empty() ? nullptr : table.species_of_id.data()};
}

} // namespace carrom
