// SPDX-License-Identifier: BSD-3-Clause
// Checkpoints on 1 to 7 ranks: what is read is what was written, to the bit; the file does not show
// who wrote it; a damaged one is noticed by all ranks.
#include "io/checkpoint.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include "catch.hpp"

#include "core/disc_columns.hpp"
#include "core/errors.hpp"
#include "core/state_hash.hpp"
#include "io/checkpoint_fields.hpp"
#include "io/checksums.hpp"
#include "io/hdf5.hpp"
#include "parallel/slabs.hpp"

using namespace carrom;

namespace {

/// A folder for all ranks, gone at the end.
class TestFolder {
public:
    explicit TestFolder(const Communicator& world)
        : world_(world), path_("/tmp/carrom_io_test_" + std::to_string(::getpid())) {
        world_.broadcast(path_);
        if (world_.is_root()) std::filesystem::create_directories(path_);
        world_.barrier();
    }
    ~TestFolder() {
        world_.barrier();
        if (world_.is_root()) std::filesystem::remove_all(path_);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;
    std::string file(const char* name) const { return path_ + "/" + name; }

private:
    const Communicator& world_;
    std::string path_;
};

/// A disc whose numbers nobody would make up: every value that doubles have is fine in a state.
Disc odd_disc(DiscId id) {
    std::mt19937_64 random(id + 1);
    Disc disc;
    disc.id = id;
    disc.x = std::ldexp(static_cast<double>(random() >> 11), -50);
    disc.y = std::ldexp(static_cast<double>(random() >> 11), -50);
    disc.vx = id % 5 == 0 ? -0.0 : std::ldexp(static_cast<double>(random() >> 11), -60);
    disc.vy = id % 7 == 0 ? std::numeric_limits<double>::denorm_min() : -disc.x;
    disc.tau = static_cast<double>(random() >> 11) * 0x1p-53 * 3;
    disc.wall_collisions = random() & columns::all_of_counter;
    disc.pair_collisions = random() & columns::all_of_counter;
    return disc;
}

double odd_spin(DiscId id) {
    return id % 3 == 0
               ? -0.0
               : std::ldexp(static_cast<double>(std::mt19937_64(id + 77)() >> 11), -55) - 0.1;
}

std::vector<double> spins_of(const std::vector<Disc>& discs) {
    std::vector<double> spins;
    for (const Disc& disc : discs) spins.push_back(odd_spin(disc.id));
    return spins;
}

/// The discs 0 .. n-1 on ranks by a rule that leaves some with none, in no order.
std::vector<Disc> share(std::uint64_t n, const Communicator& world, unsigned method) {
    std::vector<Disc> mine;
    const auto size = static_cast<std::uint64_t>(world.size());
    for (DiscId id = 0; id < n; ++id) {
        const std::uint64_t owner = method == 0   ? (id * 7919) % size
                                    : method == 1 ? size - 1
                                                  : std::min(id / 2, size - 1);
        if (owner == static_cast<std::uint64_t>(world.rank())) mine.push_back(odd_disc(id));
    }
    std::mt19937 random(method);
    std::shuffle(mine.begin(), mine.end(), random);
    return mine;
}

CheckpointHeader some_header() {
    CheckpointHeader header;
    header.program_version = "0.0.1";
    header.scene_name = "a scene.toml";
    header.scene_text = "[box]\nsize = 1 # \xc3\xa4\n\n";
    header.scene_overrides = "time.steps=5\ndiscs.seed=1";
    header.scene_lines_before_discs = 3;
    header.scene_discs_follow = 1;
    header.box_size = 0.1;
    header.radius = 0x1p-1000;
    header.method = "time-stepped";
    header.micro_steps = 4;
    header.sync_every = 6;
    header.step = 25;
    header.micro_steps_done = 100;
    return header;
}

bool same_bits(const Disc& a, const Disc& b) {
    const auto bits = [](double number) { return std::bit_cast<std::uint64_t>(number); };
    return a.id == b.id && bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) &&
           bits(a.vx) == bits(b.vx) && bits(a.vy) == bits(b.vy) && bits(a.tau) == bits(b.tau) &&
           a.wall_collisions == b.wall_collisions && a.pair_collisions == b.pair_collisions;
}

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The text and code of the error that reading ends with, the same on every rank; empty if it is
/// read.
std::string problem_of(const std::string& path, const Communicator& world) {
    try {
        read_checkpoint(path, world);
    } catch (const CollectiveError& error) {
        return std::to_string(static_cast<int>(error.code())) + ' ' + error.what();
    } catch (const InputError& error) {
        return std::string("2 ") + error.what();
    }
    return {};
}

} // namespace

TEST_CASE("a checkpoint is read as it was written") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    for (const std::uint64_t n : {1u, 2u, 5u, 1000u, 20011u}) {
        for (unsigned method = 0; method < 3; ++method) {
            const std::string path = folder.file("checkpoint.h5");
            const std::vector<Disc> mine = share(n, world, method);
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
                const Disc disc = odd_disc(id);
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
    turning.has_spins = true;
    for (const std::uint64_t n : {1u, 5u, 20011u}) {
        StateHash hash;
        for (DiscId id = 0; id < n; ++id) hash += hash_of(odd_disc(id));
        const std::string still = to_string(hash);
        for (DiscId id = 0; id < n; ++id) hash += hash_of_spin(id, odd_spin(id));
        for (unsigned method = 0; method < 3; ++method) {
            const std::vector<Disc> mine = share(n, world, method);
            write_checkpoint(path, turning, mine, world, {2}, {}, spins_of(mine));
            const Checkpoint read = read_checkpoint(path, world);
            CHECK(read.header.has_spins);
            CHECK(read_checkpoint_header(path, world).has_spins);
            CHECK(read.header.state_hash == to_string(hash));
            REQUIRE(read.spins.size() == read.discs.size());
            bool all_same = true;
            for (std::size_t i = 0; i < read.spins.size(); ++i)
                all_same = all_same && std::bit_cast<std::uint64_t>(read.spins[i]) ==
                                           std::bit_cast<std::uint64_t>(odd_spin(read.discs[i].id));
            CHECK(all_same);
        }
        write_checkpoint(path, some_header(), share(n, world, 0), world);
        const Checkpoint plain = read_checkpoint(path, world);
        CHECK(!plain.header.has_spins);
        CHECK(plain.spins.empty());
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
    for (const CheckpointHeader& header : {read_checkpoint_header(folder.file("a.h5"), world),
                                           read_checkpoint(folder.file("a.h5"), world).header}) {
        CHECK(header.program_version == wanted.program_version);
        CHECK(header.scene_name == wanted.scene_name);
        CHECK(header.scene_text == wanted.scene_text);
        CHECK(header.scene_overrides == wanted.scene_overrides);
        CHECK(header.scene_lines_before_discs == wanted.scene_lines_before_discs);
        CHECK(header.scene_discs_follow == wanted.scene_discs_follow);
        CHECK(header.box_size == wanted.box_size);
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

TEST_CASE("the file does not depend on who holds which disc, and nothing else is left") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    for (const std::uint64_t n : {777u, 9000u}) {
        CheckpointHeader header = some_header();
        header.has_spins = n == 9000;
        const auto write = [&](const char* name, unsigned method, const WriteSettings& settings) {
            const std::vector<Disc> mine = share(n, world, method);
            write_checkpoint(folder.file(name), header, mine, world, settings, {}, spins_of(mine));
        };
        write("a.h5", 0, {1});
        if (n == 777)
            std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // nor on the time of day
        write("b.h5", 1, {3});                                            // nor on the threads
        write("c.h5", 2, {2, true});                                      // nor on who writes
        const std::string bytes = bytes_of(folder.file("a.h5"));
        const bool same_bytes = bytes == bytes_of(folder.file("b.h5")) &&
                                bytes == bytes_of(folder.file("c.h5"));
        CHECK(same_bytes); // not told byte by byte
    }
    CHECK(!std::filesystem::exists(folder.file("a.h5.partial")));
}

TEST_CASE("a damaged file is refused on every rank, with the reason") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const std::string whole = folder.file("whole.h5"), path = folder.file("bad.h5");
    write_checkpoint(whole, some_header(), share(50, world, 0), world);
    const std::string good = bytes_of(whole);
    const auto refused = [&](const std::string& bytes, const std::string& reason) {
        world.barrier();
        if (world.is_root()) std::ofstream(path, std::ios::binary) << bytes;
        world.barrier();
        const std::string problem = problem_of(path, world);
        CAPTURE(problem, reason);
        CHECK(problem.substr(0, 2 + path.size()) == "2 " + path);
        CHECK(problem.find(reason) != std::string::npos);
    };
    refused("", "no HDF5 file");
    refused("some text\n", "no HDF5 file");
    refused("carrom checkpoint, format 2\nbytes 7\n", "a checkpoint of carrom 0.1");
    refused(good.substr(0, 300), "cut short");
    refused(good.substr(0, good.size() - 1), "cut short");
    refused(good + 'x', "damaged");
    refused(std::string(4096, '\0') + good.substr(512), "no HDF5 file");
    for (const std::size_t place : {std::size_t{40}, std::size_t{4095}, std::size_t{4096},
                                    std::size_t{5000}, good.size() - 1}) {
        std::string bytes = good;
        bytes[place] = static_cast<char>(bytes[place] ^ 1);
        refused(bytes, "damaged");
    }
    CHECK(problem_of(whole, world).empty());
    CHECK(problem_of(folder.file("none.h5"), world).find("No such file") != std::string::npos);
}

TEST_CASE("damage is told by the data set that it is in") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const std::string path = folder.file("a.h5");
    CheckpointHeader header = some_header();
    header.has_spins = true;
    const std::vector<Disc> mine = share(5000, world, 0);
    write_checkpoint(path, header, mine, world, {}, {}, spins_of(mine));
    const std::string good = bytes_of(path);
    const Checksums sums = read_checksums(h5::open_file(path, h5::Access::read).id());
    CHECK(sums.data.size() == 10);
    CHECK(good.substr(sums.place.begin, sums.place.end - sums.place.begin) == sums.text());
    const auto reported = [&](std::vector<std::size_t> places) {
        world.barrier();
        if (world.is_root()) {
            std::string bytes = good;
            for (const std::size_t place : places)
                bytes[place] = static_cast<char>(bytes[place] ^ 16);
            std::ofstream(path, std::ios::binary) << bytes;
        }
        world.barrier();
        const std::string problem = problem_of(path, world);
        return problem.substr(std::min(problem.size(), problem.rfind(": ") + 2));
    };
    for (const DiscData& data : sums.data)
        for (const std::size_t place :
             {data.place.begin, data.place.begin + 2500 * data.bytes_per_row, data.place.end - 1})
            CHECK(reported({place}) == data.path);
    CHECK(reported({sums.data[2].place.begin + 100, sums.data[5].place.end - 9}) ==
          "/carrom/discs/x, /carrom/discs/vy");
    CHECK(reported({good.find("box]\nsize")}).starts_with("bytes besides the data sets"));
    for (const std::size_t place : {0u, 31u, 40u, 340u})
        CHECK(reported({sums.place.begin + place}).find("its checksums") != std::string::npos);
}

namespace {

/// Flips one bit of each of these bytes in turn; every time all ranks must notice. Returns how many
/// went unnoticed.
int unnoticed_flips(const std::vector<std::size_t>& places, const Communicator& world) {
    const TestFolder folder(world);
    const std::string path = folder.file("a.h5");
    write_checkpoint(path, some_header(), share(20, world, 0), world);
    const std::string good = bytes_of(path);
    int n_unnoticed = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const std::size_t place = places[k] % good.size();
        const auto put = [&](char byte) {
            world.barrier();
            if (world.is_root())
                std::fstream(path, std::ios::binary | std::ios::in | std::ios::out)
                    .seekp(static_cast<std::streamoff>(place))
                    .put(byte);
            world.barrier();
        };
        put(static_cast<char>(good[place] ^ (1 << (k % 8))));
        n_unnoticed += problem_of(path, world).empty() ? 1 : 0;
        put(good[place]);
    }
    CHECK(problem_of(path, world).empty());
    return n_unnoticed;
}

} // namespace

TEST_CASE("random flipped bits are noticed") {
    const Communicator world = Communicator::world();
    std::mt19937 random(3210);
    std::vector<std::size_t> places(300);
    for (std::size_t& place : places) place = random();
    CHECK(unnoticed_flips(places, world) == 0);
}

TEST_CASE("a flipped bit in any byte is noticed", "[.long]") {
    const Communicator world = Communicator::world();
    std::vector<std::size_t> places(40000); // more than the file has
    for (std::size_t k = 0; k < places.size(); ++k) places[k] = k;
    CHECK(unnoticed_flips(places, world) == 0);
}

namespace {

/// Gives a changed file the checksums that a writer would have given it, without those of
/// `dropped`.
void write_checksums_again(const std::string& path, const std::string& dropped) {
    h5::File file = h5::open_file(path, h5::Access::write);
    std::string text;
    h5::read_scalar(file.id(), checksums_path, text);
    Checksums sums;
    for (const DiscColumn& column : disc_columns)
        sums.data.push_back({std::string("/carrom/discs/") + column.name, 0, 0, {}, {}});
    for (const SampleColumn& column : sample_columns) {
        const std::string name = std::string("/carrom/measurements/") + column.name;
        if (name != dropped) sums.data.push_back({name, 0, 0, {}, {}});
    }
    REQUIRE(H5Ldelete(file.id(), checksums_path, H5P_DEFAULT) >= 0);
    h5::write_scalar(file.id(), checksums_path, sums.text());
    sums = read_checksums(file.id());
    file.close("");
    const std::string bytes = bytes_of(path);
    for (DiscData& one : sums.data)
        one.checksum = checksum_of_block(
            std::as_bytes(std::span(bytes))
                .subspan(one.place.begin, one.place.end - one.place.begin),
            0);
    sums.others = checksum_of_others(path, sums.left_out());
    file = h5::open_file(path, h5::Access::write);
    h5::overwrite_scalar(file.id(), checksums_path, sums.text());
    file.close("");
}

} // namespace

TEST_CASE("a forged checkpoint with right checksums is refused where its places are none") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const std::string whole = folder.file("whole.h5"), path = folder.file("forged.h5");
    StoredSamples samples;
    samples.sums = {1, 2, 3};
    samples.have_first_places = samples.have_lengths = true;
    for (DiscId id = 0; id < 20; ++id) // fewer than a piece: all are rank 0's
        if (world.is_root()) samples.first_places.push_back({id, 0.01, 0.02, 1, -2});
    write_checkpoint(whole, some_header(), share(20, world, 0), world, {}, samples);
    const auto forged = [&](const std::string& dataset, const std::function<void(hid_t)>& change) {
        world.barrier();
        if (world.is_root()) {
            std::filesystem::copy_file(whole, path,
                                       std::filesystem::copy_options::overwrite_existing);
            h5::File file = h5::open_file(path, h5::Access::write);
            change(file.id());
            file.close("");
            write_checksums_again(path, dataset);
        }
        world.barrier();
        return problem_of(path, world);
    };
    CHECK(forged("", [](hid_t) {}).empty());
    for (const SampleColumn& column : sample_columns) {
        const std::string name = std::string("/carrom/measurements/") + column.name;
        const std::string problem = forged(
            name, [&](hid_t file) { H5Ldelete(file, name.c_str(), H5P_DEFAULT); });
        CHECK(problem.find("has no " + name) != std::string::npos);
        for (const double number : {std::numeric_limits<double>::quiet_NaN(),
                                    std::numeric_limits<double>::infinity(), 1e300}) {
            const std::string other = forged("", [&](hid_t file) {
                h5::write_rows(h5::open_dataset(file, name.c_str()).id(), {7, 8}, H5T_NATIVE_DOUBLE,
                               &number, h5::Transfer::independent);
            });
            CHECK(other.find(name + " holds what is no place") != std::string::npos);
        }
    }
}

TEST_CASE("what cannot be written is an error on every rank, and the older file stays") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const std::string path = folder.file("a.h5");
    write_checkpoint(path, some_header(), share(9, world, 0), world);
    const std::string before = bytes_of(path);
    if (world.is_root()) std::filesystem::create_directories(path + ".partial/in the way");
    world.barrier();
    int code = 0;
    try {
        write_checkpoint(path, some_header(), share(8, world, 0), world);
    } catch (const CollectiveError& error) {
        code = static_cast<int>(error.code());
    }
    CHECK(code == 4);
    CHECK(bytes_of(path) == before);
    CHECK(problem_of(path, world).empty());
}
