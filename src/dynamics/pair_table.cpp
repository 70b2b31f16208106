// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/pair_table.hpp"

#include <algorithm>

namespace carrom {

/// A row whose discs are all frozen has no ids, so pairs with this row never meet.
PairTable::PairTable(const ContactEffect& contact) {
    if (contact.pairs.empty() || contact.rows.empty()) return;
    const std::size_t n = contact.rows.size();
    auto table = std::make_shared<Table>();
    for (const SpeciesRow& row : contact.rows) table->ends.push_back(row.end);
    table->factors.assign(n * n, PairFactors::common(contact));
    const auto place_of = [&](double number) {
        return static_cast<std::size_t>(std::ranges::find(contact.rows,
                                                          static_cast<std::size_t>(number) - 1,
                                                          &SpeciesRow::row) -
                                        contact.rows.begin());
    };
    const auto number_of = [](double given, double common) {
        return std::isnan(given) ? common : given;
    };
    for (const ContactPair& pair : contact.pairs) {
        const std::size_t p = place_of(pair.first), q = place_of(pair.second);
        if (p == n || q == n) continue;
        table->factors[p * n + q] = table->factors[q * n + p] = PairFactors::of(
            number_of(pair.restitution, contact.restitution),
            number_of(pair.tangential_restitution, contact.tangential_restitution),
            number_of(pair.friction, contact.friction), contact.inertia);
    }
    table_ = std::move(table);
}

} // namespace carrom
