// SPDX-License-Identifier: BSD-3-Clause
// Exchanges over random symmetric graphs. The data that a rank sends is a function of (exchange,
// sender, receiver), so each receiver can compute what it must get.
#include "parallel/neighbour_exchange.hpp"

#include <algorithm>
#include <random>

#include "catch.hpp"

using carrom::Communicator;
using carrom::NeighbourExchange;
using carrom::Received;

namespace {

struct Item {
    std::uint32_t exchange;
    std::uint16_t sender, receiver;
    std::uint64_t number;

    friend bool operator==(const Item&, const Item&) = default;
};

std::vector<Item> parcel(std::size_t exchange, int sender, int receiver, std::size_t largest) {
    const auto s = static_cast<std::uint16_t>(sender), r = static_cast<std::uint16_t>(receiver);
    std::mt19937 random(static_cast<unsigned>(exchange) * 10007 + s * 101u + r);
    std::vector<Item> items(random() % 3 == 0 ? 0 : random() % (largest + 1));
    for (Item& item : items) item = {static_cast<std::uint32_t>(exchange), s, r, random()};
    return items;
}

/// A rank's neighbours in the exchange's random graph, possibly including itself, in random order.
/// Every rank finds the same edges.
std::vector<int> neighbours_of(std::size_t exchange, int rank, int n_ranks) {
    std::vector<int> neighbours;
    for (int other = 0; other < n_ranks; ++other) {
        const auto low = static_cast<unsigned>(std::min(rank, other)),
                   high = static_cast<unsigned>(std::max(rank, other));
        std::mt19937 edge(static_cast<unsigned>(exchange) * 7919 + low * 97 + high);
        if (edge() % 2 == 0) neighbours.push_back(other);
    }
    std::mt19937 random(static_cast<unsigned>(exchange) + static_cast<unsigned>(rank));
    std::shuffle(neighbours.begin(), neighbours.end(), random);
    return neighbours;
}

std::vector<std::vector<Item>> parcels_for(std::size_t exchange, int rank,
                                           const std::vector<int>& neighbours,
                                           std::size_t largest) {
    std::vector<std::vector<Item>> out;
    for (const int neighbour : neighbours)
        out.push_back(parcel(exchange, rank, neighbour, largest));
    return out;
}

bool is_expected(const Received<Item>& in, std::size_t exchange, int rank,
                 const std::vector<int>& neighbours, std::size_t largest) {
    if (in.n_senders() != neighbours.size()) return false;
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
        const std::span<const Item> from = in.from(k);
        if (std::vector<Item>(from.begin(), from.end()) !=
            parcel(exchange, neighbours[k], rank, largest))
            return false;
    }
    return true;
}

/// Exchanges one after the other without a barrier, each on another graph.
void check_many(const Communicator& world, std::size_t n_exchanges, std::size_t largest) {
    NeighbourExchange exchange(world);
    Received<Item> in;
    for (std::size_t number = 0; number < n_exchanges; ++number) {
        const std::vector<int> neighbours = neighbours_of(number, world.rank(), world.size());
        const auto out = parcels_for(number, world.rank(), neighbours, largest);
        exchange.exchange(neighbours, out, in);
        CHECK(is_expected(in, number, world.rank(), neighbours, largest));
    }
}

} // namespace

TEST_CASE("small parcels over changing neighbours arrive whole and in order") {
    check_many(Communicator::world(), 300, 5);
}

TEST_CASE("parcels larger than a first message arrive whole and in order") {
    check_many(Communicator::world(), 40, 5000);
}

TEST_CASE("parcels that need many messages arrive whole and in order") {
    for (const std::size_t max_message : {1u, 16u, 17u, 40u, 100u})
        check_many(Communicator::world(max_message), 15, 30);
}

TEST_CASE("a rank without neighbours takes part at no cost") {
    const Communicator world = Communicator::world();
    Received<Item> in;
    in.items.resize(3);
    NeighbourExchange exchange(world);
    exchange.exchange(std::vector<int>{}, std::vector<std::vector<Item>>{}, in);
    CHECK(in.items.empty());
    CHECK(in.n_senders() == 0);
    CHECK(world.traffic().messages == 0);
}

TEST_CASE("a small parcel is one message") {
    const Communicator world = Communicator::world();
    std::vector<int> others;
    for (int rank = 0; rank < world.size(); ++rank)
        if (rank != world.rank()) others.push_back(rank);
    const std::vector<std::vector<double>> out(others.size(), {1.5, 2.5});
    Received<double> in;
    carrom::NeighbourExchange(world).exchange(others, out, in);
    CHECK(in.items.size() == 2 * others.size());
    CHECK(world.traffic().messages == others.size());
    CHECK(world.traffic().collectives == 0);
}

TEST_CASE("two exchanges that take turns do not mix") {
    const Communicator world = Communicator::world(64);
    NeighbourExchange first(world), second(world);
    Received<Item> in_first, in_second;
    for (std::size_t number = 0; number < 40; number += 2) {
        const auto near_first = neighbours_of(number, world.rank(), world.size());
        const auto near_second = neighbours_of(number + 1, world.rank(), world.size());
        const auto out_first = parcels_for(number, world.rank(), near_first, 20);
        const auto out_second = parcels_for(number + 1, world.rank(), near_second, 20);
        first.exchange(near_first, out_first, in_first);
        second.exchange(near_second, out_second, in_second);
        CHECK(is_expected(in_first, number, world.rank(), near_first, 20));
        CHECK(is_expected(in_second, number + 1, world.rank(), near_second, 20));
    }
}
