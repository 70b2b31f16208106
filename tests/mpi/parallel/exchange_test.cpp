// SPDX-License-Identifier: BSD-3-Clause
// Any-to-any exchange, the stream to rank 0 and slabs, with contents that every rank can compute
// alone.
#include "parallel/exchange.hpp"

#include <algorithm>
#include <random>

#include "catch.hpp"

#include "parallel/slabs.hpp"

using carrom::Communicator;
using carrom::Received;

namespace {

/// The data from `sender` to `receiver`: empty, short or long.
std::vector<std::uint64_t> parcel(int trial, int sender, int receiver) {
    std::mt19937 random(static_cast<unsigned>(trial * 10007 + sender * 101 + receiver));
    const std::size_t sizes[] = {0, 0, 1, 7, 200};
    std::vector<std::uint64_t> items(sizes[random() % 5]);
    for (std::uint64_t& item : items) item = random();
    return items;
}

std::vector<int> items_of(int rank, int count) {
    std::vector<int> items;
    for (int k = 0; k < count; ++k) items.push_back(rank * 1000 + k);
    return items;
}

} // namespace

TEST_CASE("items sent to their owners arrive grouped by sender") {
    for (const std::size_t max_message :
         {Communicator::largest_message, std::size_t{1000}, std::size_t{7}}) {
        const Communicator world = Communicator::world(max_message);
        for (int trial = 0; trial < 20; ++trial) {
            std::vector<std::vector<std::uint64_t>> out;
            for (int rank = 0; rank < world.size(); ++rank)
                out.push_back(parcel(trial, world.rank(), rank));
            const Received<std::uint64_t> in = carrom::send_to_owners(world, out);
            CHECK(in.n_senders() == out.size());
            for (int rank = 0; rank < world.size(); ++rank) {
                const auto from = in.from(static_cast<std::size_t>(rank));
                CHECK(std::vector<std::uint64_t>(from.begin(), from.end()) ==
                      parcel(trial, rank, world.rank()));
            }
        }
    }
}

TEST_CASE("empty parcels and those to oneself cost no message") {
    const Communicator world = Communicator::world();
    std::vector<std::vector<int>> out(static_cast<std::size_t>(world.size()));
    out[static_cast<std::size_t>(world.rank())] = {world.rank()};
    CHECK(carrom::send_to_owners(world, out).items == std::vector<int>{world.rank()});
    CHECK(world.traffic().messages == 0);
    CHECK(world.traffic().collectives == 1);
}

TEST_CASE("a stream reaches rank 0 in rank order, in chunks of a bounded size") {
    for (const std::size_t max_message : {Communicator::largest_message, std::size_t{10}}) {
        const Communicator world = Communicator::world(max_message);
        for (const int chunk : {1, 3, 10, 100}) {
            for (const int variant : {0, 1, 2}) {
                const auto count_of = [&](int rank) {
                    return variant == 0 ? 10 : variant == 1 ? (rank * 7) % 12 : 0;
                };
                std::vector<int> all, streamed;
                for (int rank = 0; rank < world.size(); ++rank) {
                    const std::vector<int> items = items_of(rank, count_of(rank));
                    all.insert(all.end(), items.begin(), items.end());
                }
                std::size_t largest = 0, smallest = 1;
                const auto consume = [&](std::span<const int> items) {
                    streamed.insert(streamed.end(), items.begin(), items.end());
                    largest = std::max(largest, items.size());
                    smallest = std::min(smallest, items.size());
                };
                const std::vector<int> mine = items_of(world.rank(), count_of(world.rank()));
                carrom::stream_to_root(world, mine, consume, static_cast<std::size_t>(chunk));
                CHECK(streamed == (world.is_root() ? all : std::vector<int>{}));
                CHECK(largest <= static_cast<std::size_t>(chunk));
                CHECK(smallest == 1);
            }
        }
    }
}

TEST_CASE("slabs share ids out evenly, in order") {
    for (std::uint64_t n = 0; n < 40; ++n) {
        for (int size = 1; size < 12; ++size) {
            CHECK(carrom::slab_begin(0, n, size) == 0);
            CHECK(carrom::slab_begin(size, n, size) == n);
            for (int rank = 0; rank < size; ++rank) {
                const std::uint64_t first = carrom::slab_begin(rank, n, size),
                                    last = carrom::slab_begin(rank + 1, n, size);
                const std::uint64_t share = n / static_cast<std::uint64_t>(size);
                CHECK((last - first == share || last - first == share + 1));
                for (std::uint64_t id = first; id < last; ++id)
                    CHECK(carrom::slab_of(id, n, size) == rank);
            }
        }
    }
    const std::uint64_t huge = ~std::uint64_t{0};
    CHECK(carrom::slab_of(huge - 1, huge, 1000) == 999);
    CHECK(carrom::slab_begin(1000, huge, 1000) == huge);
}
