// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/species.hpp"

#include <algorithm>
#include <mutex>

namespace carrom {

namespace {

/// More species than this are not searched one by one.
constexpr std::size_t few_species = 8;

/// So many species have numbers of 16 bits.
constexpr std::size_t most_numbers = std::numeric_limits<std::uint16_t>::max() + std::size_t{1};

} // namespace

void SpeciesTable::Table::spread(std::span<const Species> species) {
    const bool has_numbers = species.size() <= most_numbers;
    // A list that grows takes up to twice what it needs.
    sizes.reserve(has_numbers ? species.size() : n_discs);
    if (has_numbers) species_of_id.reserve(n_discs);
    for (const Species& one : species) {
        if (has_numbers)
            species_of_id.insert(species_of_id.end(), one.count,
                                 static_cast<std::uint16_t>(sizes.size()));
        sizes.insert(sizes.end(), has_numbers ? 1 : one.count, {one.radius, one.mass});
    }
}

SpeciesTable::SpeciesTable(std::span<const Species> species, double radius) {
    auto table = std::make_shared<Table>();
    DiscId end = 0;
    for (const Species& one : species) {
        end += one.count;
        table->ranges.push_back({end, {one.radius, one.mass}});
    }
    table->ranges.push_back(
        {std::numeric_limits<DiscId>::max(),
         species.empty() ? SizeAndMass{radius, 1} : table->ranges.back().values});
    if (!species.empty()) table->ranges.erase(table->ranges.end() - 2); // the last one has no end
    table->n_discs = end;
    table_ = table;
    if (species.size() > few_species) {
        // A run has several tables of the same discs. They share their memory.
        static std::mutex one_at_a_time;
        static std::weak_ptr<const Table> last;
        const auto is_same = [](const Range& a, const Range& b) {
            return a.end == b.end && a.values.radius == b.values.radius &&
                   a.values.mass == b.values.mass;
        };
        const std::scoped_lock lock(one_at_a_time);
        const std::shared_ptr<const Table> known = last.lock();
        if (known && known->n_discs == end &&
            std::ranges::equal(known->ranges, table->ranges, is_same)) {
            table_ = known;
        } else {
            table->spread(species);
            last = table_;
        }
    }
    ranges_ = table_->ranges.data();
    sizes_ = table_->sizes.empty() ? nullptr : table_->sizes.data();
    species_of_id_ = table_->species_of_id.empty() ? nullptr : table_->species_of_id.data();
}

} // namespace carrom
