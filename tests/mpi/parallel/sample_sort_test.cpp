// SPDX-License-Identifier: BSD-3-Clause
// The distributed sort, compared with std::stable_sort of all ranks' records, which each rank can
// generate itself.
#include "parallel/sample_sort.hpp"

#include <functional>
#include <limits>
#include <random>

#include "catch.hpp"

using carrom::Communicator;

namespace {

/// Sorted by key alone. Origin and place distinguish equal records and show whether the sort is
/// stable.
struct Record {
    double key;
    int origin, place;

    friend bool operator==(const Record&, const Record&) = default;
};

bool by_key(const Record& a, const Record& b) { return a.key < b.key; }

/// A way to fill the ranks: the keys of one rank's records.
using Filling = std::function<std::vector<double>(int rank, int n_ranks)>;

std::vector<double> random_keys(int rank, std::size_t count, std::uint32_t n_distinct) {
    std::mt19937 random(static_cast<unsigned>(rank) + 17);
    std::vector<double> keys(count);
    for (double& key : keys) key = static_cast<double>(random() % n_distinct);
    return keys;
}

std::vector<double> ramp(int rank, int n_ranks, bool is_reversed) {
    std::vector<double> keys;
    for (int k = 0; k < 300; ++k)
        keys.push_back((is_reversed ? -1 : 1) * (k + 300 * rank) +
                       (is_reversed ? 300 * n_ranks : 0));
    return keys;
}

std::vector<Record> records_of(const Filling& filling, int rank, int n_ranks) {
    std::vector<Record> records;
    for (const double key : filling(rank, n_ranks))
        records.push_back({key, rank, static_cast<int>(records.size())});
    return records;
}

/// Compares each slice with the part of the reference that begins after all records of earlier
/// slices.
void check_sort(const Communicator& world, const Filling& filling, int n_slices, bool is_balanced) {
    std::vector<Record> all;
    for (int rank = 0; rank < world.size(); ++rank) {
        const std::vector<Record> records = records_of(filling, rank, world.size());
        all.insert(all.end(), records.begin(), records.end());
    }
    std::stable_sort(all.begin(), all.end(), by_key);

    const std::vector<Record> slice = carrom::sample_sort(
        world, records_of(filling, world.rank(), world.size()), by_key, n_slices);
    const std::vector<std::size_t> counts = world.all_gather(slice.size());
    std::size_t begin = 0, total = 0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        if (static_cast<int>(k) < world.rank()) begin += counts[k];
        total += counts[k];
        if (static_cast<int>(k) >= n_slices) CHECK(counts[k] == 0);
    }
    CHECK(total == all.size());
    if (total != all.size()) return;
    CHECK(std::equal(slice.begin(), slice.end(), all.begin() + static_cast<std::ptrdiff_t>(begin)));
    // Equal records stay together: a slice never begins with the last key of the slice before.
    if (!slice.empty() && begin > 0) CHECK(all[begin - 1].key < slice.front().key);
    const double share = static_cast<double>(total) / n_slices;
    const double excess = 1 + world.size() / 64.0;
    if (is_balanced) CHECK(static_cast<double>(slice.size()) <= share * excess * 1.02 + 2);
}

void check_all_slicings(const Filling& filling, bool is_balanced = false) {
    for (const std::size_t max_message : {Communicator::largest_message, std::size_t{100}}) {
        const Communicator world = Communicator::world(max_message);
        for (int n_slices = 1; n_slices <= world.size(); ++n_slices)
            check_sort(world, filling, n_slices, is_balanced);
    }
}

} // namespace

TEST_CASE("sort: random records") {
    check_all_slicings([](int rank, int) { return random_keys(rank, 3000, ~0u); }, true);
}

TEST_CASE("sort: ranks of very different counts") {
    check_all_slicings(
        [](int rank, int) {
            return random_keys(rank, static_cast<std::size_t>(rank * rank * 200), ~0u);
        },
        true);
}

TEST_CASE("sort: all records on one rank") {
    check_all_slicings([](int rank, int) { return random_keys(rank, rank == 0 ? 5000 : 0, ~0u); },
                       true);
    check_all_slicings(
        [](int rank, int n) { return random_keys(rank, rank == n - 1 ? 5000 : 0, ~0u); }, true);
}

TEST_CASE("sort: all records equal") {
    check_all_slicings([](int, int) { return std::vector<double>(500, 4.0); });
}

TEST_CASE("sort: many duplicates of few keys") {
    check_all_slicings([](int rank, int) { return random_keys(rank, 1000, 5); });
    check_all_slicings([](int rank, int) { return random_keys(rank, 1000, 40); });
}

TEST_CASE("sort: one key outweighs all others") {
    check_all_slicings([](int rank, int) {
        std::vector<double> keys = random_keys(rank, 1000, 1000);
        for (std::size_t k = 0; k < keys.size(); ++k)
            if (k % 10 != 0) keys[k] = 500;
        return keys;
    });
}

TEST_CASE("sort: no records") {
    check_all_slicings([](int, int) { return std::vector<double>(); });
}

TEST_CASE("sort: fewer records than ranks") {
    check_all_slicings(
        [](int rank, int n) { return std::vector<double>(rank == n / 2 ? 1 : 0, 1.0); });
    check_all_slicings(
        [](int rank, int n) { return std::vector<double>(rank % 2 == 1 ? 1 : 0, n - rank); });
}

TEST_CASE("sort: records in order and in reverse") {
    check_all_slicings([](int rank, int n) { return ramp(rank, n, false); }, true);
    check_all_slicings([](int rank, int n) { return ramp(rank, n, true); }, true);
}

TEST_CASE("sort: infinities and both zeros") {
    check_all_slicings([](int rank, int) {
        const double inf = std::numeric_limits<double>::infinity();
        return std::vector<double>{inf, -0.0, 1.0 * rank, 0.0, -inf, -1.0 * rank};
    });
}

TEST_CASE("sort: nothing is sent on one rank, and no sample for one slice") {
    const Communicator world = Communicator::world();
    carrom::sample_sort(world, std::vector<int>{3, 1, 2}, std::less<int>(), 1);
    CHECK(world.traffic().collectives == (world.size() == 1 ? 0 : 1));
    CHECK(world.traffic().messages == (world.is_root() ? 0 : 1));
}
