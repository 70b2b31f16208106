// SPDX-License-Identifier: BSD-3-Clause
// Tables of species: each disc has the radius and the mass of its species, and copies share
// their memory.
#include <cstddef>
#include <vector>

#include "catch.hpp"

#include "dynamics/species.hpp"

using namespace carrom;

namespace {

std::vector<Species> species_of(std::size_t n, std::uint64_t last_count) {
    std::vector<Species> species;
    for (std::size_t k = 0; k < n; ++k)
        species.push_back({k + 1, 1 + 0.5 * static_cast<double>(k), 2 + static_cast<double>(k)});
    species.back().count = last_count;
    return species;
}

} // namespace

TEST_CASE("each disc has the radius and the mass of its species, be they few or many") {
    for (const std::size_t n : {1u, 3u, 8u, 9u, 40u}) {
        const std::vector<Species> species = species_of(n, 5);
        const SpeciesTable table(species, 7);
        DiscId id = 0;
        for (const Species& one : species) {
            for (std::uint64_t k = 0; k < one.count; ++k, ++id) {
                CHECK(table.of(id).radius == one.radius);
                CHECK(table.of(id).mass == one.mass);
            }
        }
    }
    CHECK(SpeciesTable({}, 7).of(3).radius == 7);
    CHECK(SpeciesTable({}, 7).of(3).mass == 1);
}

TEST_CASE("more species than 16 bits can number have their radii, too") {
    for (const std::size_t n : {65'536u, 65'537u}) {
        std::vector<Species> species;
        for (std::size_t k = 0; k < n; ++k)
            species.push_back({2, 1 + static_cast<double>(k), 3 + static_cast<double>(k)});
        const SpeciesTable table(species, 7);
        bool are_right = true;
        for (DiscId id = 0; id < 2 * n; ++id) {
            const Species& one = species[id / 2];
            are_right &= table.of(id).radius == one.radius && table.of(id).mass == one.mass;
        }
        CHECK(are_right);
    }
}

TEST_CASE("copies of a table share its memory, and outlive it") {
    const std::vector<Species> many = species_of(20, 5);
    const auto copy_of = [](const SpeciesTable& table) { return table; };
    const SpeciesTable first(many, 1), second = copy_of(first);
    CHECK(&first.of(100) == &second.of(100));
    const SpeciesTable alone = copy_of(SpeciesTable(many, 1));
    CHECK(&alone.of(100) != &first.of(100));
    CHECK(alone.of(194).radius == many.back().radius);
    CHECK(alone.of(7).mass == many[3].mass);
}
