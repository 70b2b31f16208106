// SPDX-License-Identifier: BSD-3-Clause
// Reductions, broadcasts and gathers, compared with results that each rank can compute on its own.
#include "parallel/communicator.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "catch.hpp"

#include "core/exact_sum.hpp"
#include "parallel/joint_reduction.hpp"

using carrom::Communicator;

TEST_CASE("sums and a largest value are reduced together") {
    const Communicator world = Communicator::world();
    const auto n = static_cast<std::uint64_t>(world.size()),
               rank = static_cast<std::uint64_t>(world.rank());
    struct Counts {
        std::uint64_t ranks, numbers, nothing, large, squares;
    };
    carrom::JointReduction<Counts> values;
    values.counts = {1, rank, 0, std::uint64_t{1} << 60, rank * rank};
    values.largest = world.rank() == world.size() / 2 ? 2.5 : 0.5;
    const std::uint64_t n_before = world.traffic().collectives;
    reduce(values, world);
    CHECK(world.traffic().collectives == n_before + 1);
    CHECK(values.counts.ranks == n);
    CHECK(values.counts.numbers == n * (n - 1) / 2);
    CHECK(values.counts.nothing == 0);
    CHECK(values.counts.large == n << 60);
    CHECK(values.counts.squares == (n - 1) * n * (2 * n - 1) / 6);
    CHECK(values.largest == 2.5);
}

TEST_CASE("reductions give every rank the value over all ranks") {
    const Communicator world = Communicator::world();
    const int last = world.size() - 1;
    CHECK(world.max(-1.5 * world.rank()) == 0);
    CHECK(world.min(-1.5 * world.rank()) == -1.5 * last);
    CHECK(world.max(std::int64_t{-world.rank()}) == 0);
    CHECK(world.min(std::int64_t{-world.rank()}) == -last);
    CHECK(world.max(static_cast<std::uint64_t>(world.rank())) == static_cast<std::uint64_t>(last));
    CHECK(world.min(static_cast<std::uint64_t>(world.rank() + 3)) == 3);
    CHECK(world.max(world.rank() == last ? std::numeric_limits<std::uint64_t>::max() : 0) ==
          std::numeric_limits<std::uint64_t>::max());
    CHECK(world.any(world.rank() == last));
    CHECK_FALSE(world.any(false));
    CHECK(world.all(true));
    CHECK(world.all(world.rank() != last) == false);
}

TEST_CASE("what one rank does by itself waits for no other") {
    const Communicator world = Communicator::world();
    if (!world.is_root()) return;
    const Communicator alone = Communicator::of_this_rank();
    CHECK(alone.size() == 1);
    CHECK(alone.is_root());
    CHECK(alone.sum(std::uint64_t{7}) == 7);
    alone.barrier();
}

TEST_CASE("a zero comes out of a reduction without a sign") {
    const Communicator world = Communicator::world();
    CHECK_FALSE(std::signbit(world.max(-0.0)));
    CHECK_FALSE(std::signbit(world.min(world.rank() == 0 ? -0.0 : 0.0)));
}

TEST_CASE("sums wrap and add element by element, also in many messages") {
    const Communicator world = Communicator::world(24); // three numbers in each message
    const auto n = static_cast<std::uint64_t>(world.size()),
               rank = static_cast<std::uint64_t>(world.rank());
    CHECK(world.sum(rank) == n * (n - 1) / 2);
    CHECK(world.sum(~std::uint64_t{0}) == 0 - n);
    CHECK(world.sum_before(rank + 1) == rank * (rank + 1) / 2);
    std::vector<std::uint64_t> values;
    for (std::uint64_t k = 0; k < 10; ++k) values.push_back(k * (rank + 1));
    world.sum(values);
    for (std::uint64_t k = 0; k < 10; ++k) CHECK(values[k] == k * n * (n + 1) / 2);
}

TEST_CASE("an exact sum over ranks has the bits of the sum on one rank") {
    const Communicator world = Communicator::world();
    const double bound = 1e6;
    carrom::ExactSum mine(bound), all(bound);
    for (int rank = 0; rank < world.size(); ++rank)
        for (int k = 0; k < 50; ++k) {
            const double term = (k % 2 == 0 ? 1 : -1.001) * 1234.567 / (1 + 7.0 * k + rank);
            all.add(term);
            if (rank == world.rank()) mine.add(term);
        }
    world.sum(mine);
    CHECK(mine.low_word() == all.low_word());
    CHECK(mine.high_word() == all.high_word());
    CHECK(mine.value() == all.value());
}

TEST_CASE("an exact sum carries from its low word to its high one, up and down") {
    const Communicator world = Communicator::world();
    const double n = world.size();
    carrom::ExactSum up(64), down(64); // the unit is 2^-118, so 2^-55 is half a low word
    up.add(0x1p-55);
    world.sum(up);
    CHECK(up.value() == n * 0x1p-55);
    down.add(world.is_root() ? 0x1p-54 : -0x1p-100);
    world.sum(down);
    CHECK(down.value() == 0x1p-54 - (n - 1) * 0x1p-100);
}

TEST_CASE("a broadcast replaces what the others have, from any root, in pieces") {
    for (const std::size_t max_message : {Communicator::largest_message, std::size_t{5}}) {
        const Communicator world = Communicator::world(max_message);
        for (int root = 0; root < world.size(); ++root) {
            const bool is_source = world.rank() == root;
            std::string text = is_source ? "seventeen letters"
                                         : std::string(static_cast<std::size_t>(world.rank()), '?');
            world.broadcast(text, root);
            CHECK(text == "seventeen letters");
            std::string empty = is_source ? "" : "something";
            world.broadcast(empty, root);
            CHECK(empty.empty());
            double number = is_source ? 2.5 : 0;
            world.broadcast(number, root);
            CHECK(number == 2.5);
            std::vector<int> numbers = is_source ? std::vector<int>{1, 2, 3, root}
                                                 : std::vector<int>(9, 0);
            world.broadcast(numbers, root);
            CHECK(numbers == std::vector<int>{1, 2, 3, root});
        }
    }
}

TEST_CASE("a gather gives every rank the values in rank order") {
    struct Pair {
        int a;
        double b;
    };
    const Communicator world = Communicator::world();
    const std::vector<Pair> all = world.all_gather(Pair{world.rank(), 0.5 * world.rank()});
    CHECK(all.size() == static_cast<std::size_t>(world.size()));
    for (std::size_t k = 0; k < all.size(); ++k) {
        CHECK(all[k].a == static_cast<int>(k));
        CHECK(all[k].b == 0.5 * static_cast<double>(k));
    }
}

TEST_CASE("calls that involve all ranks are counted") {
    const Communicator world = Communicator::world();
    CHECK(world.traffic().collectives == 0);
    world.barrier();
    world.any(false);
    CHECK(world.traffic().collectives == 2);
    CHECK(world.traffic().messages == 0);
}
