// SPDX-License-Identifier: BSD-3-Clause
// Pieces of ids, and records that come to them from any ranks, with contents that every rank can
// work out alone.
#include "parallel/pieces.hpp"

#include <algorithm>
#include <random>
#include <span>
#include <vector>

#include "catch.hpp"

using carrom::Communicator;
using carrom::Pieces;

namespace {

struct Record {
    double value = 0;
    std::uint64_t id = 0;
};

} // namespace

TEST_CASE("pieces cover all ids, and each rank has a run of them") {
    for (const std::uint64_t n :
         {0ul, 1ul, 1024ul, 1025ul, 20011ul, 10'000'000ul, 1'000'000'007ul}) {
        for (const int size : {1, 2, 3, 7, 1000}) {
            const Pieces pieces(n, size);
            CHECK(pieces.begin(0) == 0);
            CHECK(pieces.begin(pieces.count()) == n);
            CHECK(pieces.rows() % Pieces::least_rows == 0);
            CHECK(pieces.rows() <= Pieces::most_rows);
            CHECK(pieces.first_of(0) == 0);
            CHECK(pieces.first_of(size) == pieces.count());
            if (n > 0) CHECK(pieces.of(n - 1) == pieces.count() - 1);
            for (int rank = 0; rank < size; ++rank) {
                const std::uint64_t first = pieces.first_of(rank), last = pieces.first_of(rank + 1);
                CHECK(last - first <= pieces.n_rounds());
                // No rank has more than an eighth and a piece above its share.
                const auto share = static_cast<double>(n) / size;
                CHECK(static_cast<double>(pieces.begin(last) - pieces.begin(first)) <=
                      1.125 * share + static_cast<double>(Pieces::least_rows));
            }
        }
    }
}

TEST_CASE("records in any place come to their pieces in order") {
    const Communicator world = Communicator::world();
    for (const std::uint64_t n : {0u, 1u, 2u, 1000u, 1024u, 1025u, 30011u}) {
        std::vector<std::uint64_t> ids;
        for (std::uint64_t id = 0; id < n; ++id) ids.push_back(id);
        std::mt19937 random(static_cast<unsigned>(n)); // the same on all ranks
        std::shuffle(ids.begin(), ids.end(), random);
        std::vector<Record> mine;
        for (const std::uint64_t id : ids)
            if (static_cast<int>(random() % static_cast<unsigned>(world.size() * world.size())) /
                    world.size() ==
                world.rank())
                mine.push_back({0.5 * static_cast<double>(id), id});
        carrom::PieceStream stream(world, std::span<const Record>(mine), n,
                                   [](const Record& record) { return record.id; });
        const Pieces pieces(n, world.size());
        std::uint64_t next = pieces.begin(pieces.first_of(world.rank()));
        bool all_in_order = true;
        for (std::uint64_t round = 0; round < stream.pieces().n_rounds(); ++round) {
            const std::span<const Record> piece = stream.next();
            all_in_order = all_in_order && (piece.empty() || stream.begin() == next);
            for (const Record& record : piece) {
                all_in_order = all_in_order && record.id == next &&
                               record.value == 0.5 * static_cast<double>(next);
                ++next;
            }
        }
        CHECK(all_in_order);
        CHECK(next == pieces.begin(pieces.first_of(world.rank() + 1)));
    }
}
