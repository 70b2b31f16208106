// SPDX-License-Identifier: BSD-3-Clause
// Pieces of ids. The records come from any ranks, and every rank can compute their contents alone.
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

/// Sends n records, which lie anywhere, to the pieces of n_owners ranks.
void check_records(std::uint64_t n, int n_owners) {
    const Communicator world = Communicator::world();
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
    const Pieces pieces(n, world.size(), n_owners);
    carrom::PieceStream stream(world, std::span<const Record>(mine), pieces, n,
                               [](const Record& record) { return record.id; });
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
                // No rank has more than an eighth and one piece above its share.
                const auto share = static_cast<double>(n) / size;
                CHECK(static_cast<double>(pieces.begin(last) - pieces.begin(first)) <=
                      1.125 * share + static_cast<double>(Pieces::least_rows));
            }
        }
    }
}

TEST_CASE("pieces of few owners: every so-many-th rank has a run") {
    for (const int size : {1, 7, 65, 1000}) {
        for (const int n_owners : {1, 3, 64}) {
            if (n_owners > size) continue;
            const Pieces pieces(1'000'000'007ul, size, n_owners);
            int n_with_pieces = 0, last_owner = 0, longest_gap = 0;
            for (int rank = 0; rank < size; ++rank) {
                const std::uint64_t first = pieces.first_of(rank), last = pieces.first_of(rank + 1);
                CHECK(first <= last);
                CHECK(last - first <= pieces.n_rounds());
                if (first == last) continue;
                ++n_with_pieces;
                longest_gap = std::max(longest_gap, rank - last_owner);
                last_owner = rank;
            }
            CHECK(n_with_pieces == n_owners);
            CHECK(longest_gap <= (size + n_owners - 1) / n_owners);
            CHECK(pieces.first_of(0) == 0);
            CHECK(pieces.first_of(size) == pieces.count());
        }
    }
}

TEST_CASE("records in any place come to their pieces in order") {
    const int n_ranks = Communicator::world().size();
    for (const std::uint64_t n : {0u, 1u, 2u, 1000u, 1024u, 1025u, 30011u})
        for (const int n_owners : {n_ranks, std::min(2, n_ranks)}) check_records(n, n_owners);
}
