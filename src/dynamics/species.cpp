// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/species.hpp"

#include <algorithm>
#include <mutex>

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
    }
    table->ranges.push_back(
        {std::numeric_limits<DiscId>::max(),
         species.empty() ? SizeAndMass{radius, 1} : table->ranges.back().values});
    if (!species.empty()) table->ranges.erase(table->ranges.end() - 2); // the last one has no end
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
        if (known && known->by_id.size() == end &&
            std::ranges::equal(known->ranges, table->ranges, is_same)) {
            table_ = known;
        } else {
            table->by_id.reserve(end); // a list that grows takes up to twice what it needs
            for (const Species& one : species)
                table->by_id.insert(table->by_id.end(), one.count, {one.radius, one.mass});
            last = table_;
        }
    }
    ranges_ = table_->ranges.data();
    by_id_ = table_->by_id.empty() ? nullptr : table_->by_id.data();
}

} // namespace carrom
