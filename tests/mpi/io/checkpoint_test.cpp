// SPDX-License-Identifier: BSD-3-Clause
// Checkpoints on 1 to 7 ranks: data that are read equal the written data, bit by bit; the file does
// not depend on the ranks that wrote it; all ranks detect a damaged file.
#include "checkpoint_tools.hpp"

using namespace carrom;
using namespace carrom::test;

TEST_CASE("a checkpoint is read as it was written") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    for (const std::uint64_t n : {1u, 2u, 5u, 1000u, 20011u}) {
        for (unsigned method = 0; method < 3; ++method) {
            const std::string path = folder.file("checkpoint.h5");
            const std::vector<DiscState> mine = share(n, world, method);
            write_checkpoint(path, some_header(), mine, world);
            const Checkpoint read = read_checkpoint(path, world);
            const DiscId first = slab_begin(world.rank(), n, world.size());
            CHECK(first + read.discs.size() == slab_begin(world.rank() + 1, n, world.size()));
            bool all_same = true;
            std::uint64_t walls = 0, pairs = 0;
            StateHash hash;
            for (std::size_t i = 0; i < read.discs.size(); ++i)
                all_same = all_same && same_bits(read.discs[i], odd_disc(first + i));
            for (DiscId id = 0; id < n; ++id) {
                const DiscState disc = odd_disc(id);
                walls += disc.wall_collisions;
                pairs += disc.pair_collisions;
                hash += hash_of(disc);
            }
            CHECK(all_same);
            const CheckpointHeader& header = read.header;
            CHECK(header.n_discs == n);
            CHECK(header.state_hash == to_string(hash));
            CHECK(header.wall_collisions == walls);
            CHECK(header.pair_collisions == pairs / 2);
        }
    }
}

TEST_CASE("spins are read as they were written, and are part of the state hash") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const std::string path = folder.file("spins.h5");
    CheckpointHeader turning = some_header();
    turning.columns.add(SideColumn::spin);
    for (const std::uint64_t n : {1u, 5u, 20011u}) {
        StateHash hash;
        for (DiscId id = 0; id < n; ++id) hash += hash_of(odd_disc(id));
        const std::string still = to_string(hash);
        for (DiscId id = 0; id < n; ++id) hash += hash_of(SideColumn::spin, id, odd_spin(id));
        for (unsigned method = 0; method < 3; ++method) {
            const std::vector<DiscState> mine = share(n, world, method);
            const SideColumns columns = spins_of(mine);
            write_checkpoint(path, turning, mine, world, {2}, {}, columns.spans());
            const Checkpoint read = read_checkpoint(path, world);
            CHECK(read.header.columns.has(SideColumn::spin));
            CHECK(check_damage(path, world)->columns.has(SideColumn::spin));
            CHECK(read.header.state_hash == to_string(hash));
            const std::vector<double>& spins = read.columns[SideColumn::spin];
            REQUIRE(spins.size() == read.discs.size());
            bool all_same = true;
            for (std::size_t i = 0; i < spins.size(); ++i)
                all_same = all_same && std::bit_cast<std::uint64_t>(spins[i]) ==
                                           std::bit_cast<std::uint64_t>(odd_spin(read.discs[i].id));
            CHECK(all_same);
        }
        write_checkpoint(path, some_header(), share(n, world, 0), world);
        const Checkpoint plain = read_checkpoint(path, world);
        CHECK(!plain.header.columns.has(SideColumn::spin));
        CHECK(plain.columns[SideColumn::spin].empty());
        CHECK(plain.header.state_hash == still);
    }
}

TEST_CASE("the header comes back whole") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    CheckpointHeader wanted = some_header();
    wanted.species = {{2, 1.5, 3}, {1, 0.5, 1}};
    wanted.scene_text += std::string(200000, 'x') + '\n'; // longer than HDF5's attributes may be
    write_checkpoint(folder.file("a.h5"), wanted, share(3, world, 0), world);
    for (const CheckpointHeader& header : {*check_damage(folder.file("a.h5"), world),
                                           read_checkpoint(folder.file("a.h5"), world).header}) {
        CHECK(header.program_version == wanted.program_version);
        CHECK(header.scene_name == wanted.scene_name);
        CHECK(header.scene_text == wanted.scene_text);
        CHECK(header.scene_overrides == wanted.scene_overrides);
        CHECK(header.scene_lines_before_discs == wanted.scene_lines_before_discs);
        CHECK(header.scene_discs_follow == wanted.scene_discs_follow);
        CHECK(header.box() == wanted.box());
        CHECK(header.radius == wanted.radius);
        CHECK(header.method == wanted.method);
        CHECK(header.micro_steps == wanted.micro_steps);
        CHECK(header.sync_every == wanted.sync_every);
        CHECK(header.step == wanted.step);
        CHECK(header.species == wanted.species);
        CHECK(header.micro_steps_done == wanted.micro_steps_done);
        CHECK(header.clock() == 4.0);
    }
}

TEST_CASE("a rectangle's edges come back, and a square's file has one edge as ever") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const auto has_height = [&](const std::string& path) {
        return h5::has(h5::open_file(path, h5::Access::read).id(), "/carrom/run/box_height");
    };
    for (const Box& box : {Box(0.1), Box(0.1, 0.3), Box(0.3, 0.1)}) {
        CheckpointHeader wanted = some_header();
        wanted.set_box(box);
        const std::string path = folder.file("a.h5");
        write_checkpoint(path, wanted, share(3, world, 0), world);
        CHECK(check_damage(path, world)->box() == box);
        CHECK(read_checkpoint(path, world).header.box() == box);
        if (world.is_root()) CHECK(has_height(path) == !box.is_square());
        world.barrier();
    }
    CheckpointHeader flat = some_header();
    flat.set_box({0.1, 0});
    write_checkpoint(folder.file("flat.h5"), flat, share(3, world, 0), world);
    CHECK(problem_of(folder.file("flat.h5"), world).find("numbers contradict each other") !=
          std::string::npos);
}

TEST_CASE("the file does not depend on who holds which disc, and nothing else is left") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    for (const std::uint64_t n : {777u, 9000u}) {
        CheckpointHeader header = some_header();
        if (n == 9000) header.columns.add(SideColumn::spin);
        const auto write = [&](const char* name, unsigned method, const WriteSettings& settings) {
            const std::vector<DiscState> mine = share(n, world, method);
            const SideColumns columns = spins_of(mine);
            write_checkpoint(folder.file(name), header, mine, world, settings, {}, columns.spans());
        };
        write("a.h5", 0, {1});
        // The file depends neither on the clock, nor on the number of threads, nor on the ranks
        // that write.
        if (n == 777) std::this_thread::sleep_for(std::chrono::milliseconds(1100));
        write("b.h5", 1, {3});
        write("c.h5", 2, {2, true});
        const std::string bytes = bytes_of(folder.file("a.h5"));
        const bool same_bytes = bytes == bytes_of(folder.file("b.h5")) &&
                                bytes == bytes_of(folder.file("c.h5"));
        CHECK(same_bytes); // one check, because one for each byte would print too much
    }
    if (world.is_root()) {
        const std::filesystem::directory_iterator files(folder.file("")), end;
        CHECK(std::distance(files, end) == 3);
    }
}

TEST_CASE("what cannot be written is an error on every rank, and the older file stays") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const std::string path = folder.file("a.h5");
    write_checkpoint(path, some_header(), share(9, world, 0), world);
    const std::string before = bytes_of(path);
    const std::string in_the_way = folder.file("folder.h5"), nowhere = folder.file("none/a.h5");
    if (world.is_root()) std::filesystem::create_directories(in_the_way + "/file");
    world.barrier();
    for (const std::string& target : {in_the_way, nowhere}) {
        int code = 0;
        try {
            write_checkpoint(target, some_header(), share(8, world, 0), world);
        } catch (const CollectiveError& error) {
            code = static_cast<int>(error.code());
        }
        CHECK(code == 4);
    }
    if (world.is_root()) { // the unfinished file is gone
        const std::filesystem::directory_iterator files(folder.file("")), end;
        CHECK(std::distance(files, end) == 2);
    }
    CHECK(bytes_of(path) == before);
    CHECK(problem_of(path, world).empty());
}
