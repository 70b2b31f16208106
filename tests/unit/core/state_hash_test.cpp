// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "core/state_hash.hpp"

using namespace carrom;

namespace {

DiscState some_disc(DiscId id, std::mt19937_64& engine) {
    const auto number = [&engine] { return static_cast<double>(engine() >> 11) * 0x1p-50 - 4; };
    DiscState disc;
    disc.x = number();
    disc.y = number();
    disc.vx = number();
    disc.vy = number();
    disc.tau = number();
    disc.id = id;
    disc.wall_collisions = engine() & 127;
    disc.pair_collisions = engine() & 127;
    return disc;
}

std::vector<DiscState> some_discs(std::size_t count) {
    std::mt19937_64 engine(1);
    std::vector<DiscState> discs;
    for (std::size_t i = 0; i < count; ++i) discs.push_back(some_disc(i, engine));
    return discs;
}

} // namespace

TEST_CASE("the state hash is blind to order and to who holds which disc") {
    std::vector<DiscState> discs = some_discs(1000);
    const StateHash whole = hash_of(discs);
    std::mt19937_64 engine(2);
    std::shuffle(discs.begin(), discs.end(), engine);
    CHECK(hash_of(discs) == whole);
    for (const std::size_t cut :
         {std::size_t{0}, std::size_t{1}, std::size_t{499}, std::size_t{1000}}) {
        StateHash parts = hash_of(std::span(discs).subspan(cut));
        parts += hash_of(std::span(discs).first(cut));
        CHECK(parts == whole);
    }
    CHECK(hash_of(std::span<const DiscState>()) == StateHash{});
}

TEST_CASE("the state hash sees every field's last bit") {
    const DiscState disc = some_discs(1)[0];
    std::set<std::string> hashes = {to_string(hash_of(disc))};
    for (double DiscState::* field :
         {&DiscState::x, &DiscState::y, &DiscState::vx, &DiscState::vy, &DiscState::tau}) {
        for (int bit = 0; bit < 64; ++bit) {
            DiscState other = disc;
            other.*field = std::bit_cast<double>(std::bit_cast<std::uint64_t>(disc.*field) ^
                                                 (std::uint64_t{1} << bit));
            hashes.insert(to_string(hash_of(other)));
        }
    }
    for (int bit = 0; bit < 64; ++bit) {
        DiscState other = disc;
        other.id ^= std::uint64_t{1} << bit;
        hashes.insert(to_string(hash_of(other)));
    }
    for (int bit = 0; bit < 47; ++bit) {
        DiscState more_walls = disc, more_pairs = disc;
        more_walls.wall_collisions ^= std::uint64_t{1} << bit;
        more_pairs.pair_collisions ^= std::uint64_t{1} << bit;
        hashes.insert(to_string(hash_of(more_walls)));
        hashes.insert(to_string(hash_of(more_pairs)));
    }
    DiscState departed = disc;
    departed.is_departed = 1;
    hashes.insert(to_string(hash_of(departed)));
    CHECK(hashes.size() == 1 + 6 * 64 + 2 * 47 + 1);
}

TEST_CASE("the state hash tells exchanged values and exchanged states apart") {
    DiscState disc = some_discs(1)[0];
    const StateHash before = hash_of(disc);
    std::swap(disc.x, disc.y);
    CHECK(!(hash_of(disc) == before));

    std::vector<DiscState> discs = some_discs(2);
    const StateHash both = hash_of(discs);
    std::swap(discs[0].id, discs[1].id);
    CHECK(!(hash_of(discs) == both));
    // If equal hashes cancelled each other, as in an exclusive or, a disc that occurs twice would
    // not be noticed.
    const std::vector<DiscState> twice = {discs[0], discs[0]};
    CHECK(!(hash_of(twice) == StateHash{}));
}

TEST_CASE("minus zero counts as plus zero, denormals count") {
    for (double DiscState::* field :
         {&DiscState::x, &DiscState::y, &DiscState::vx, &DiscState::vy, &DiscState::tau}) {
        DiscState zero = some_discs(1)[0];
        zero.*field = 0.0;
        DiscState minus_zero = zero;
        minus_zero.*field = -0.0;
        CHECK(hash_of(minus_zero) == hash_of(zero));
        DiscState denormal = zero;
        denormal.*field = 5e-324;
        CHECK(!(hash_of(denormal) == hash_of(zero)));
    }
}

TEST_CASE("the state hash is carried on from word to word") {
    StateHash sum{~std::uint64_t{0}, 1};
    sum += StateHash{1, 2};
    CHECK(sum.low == 0);
    // two sums of 64 bits, or one of 128 bits: the order matters for neither
    CHECK((sum.high == 3 || sum.high == 4));
}

TEST_CASE("a hash prints as 32 digits, the high half first") {
    CHECK(to_string(StateHash{0x1, 0xabc}) == "0000000000000abc0000000000000001");
}
