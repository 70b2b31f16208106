// SPDX-License-Identifier: BSD-3-Clause
// Discs and headers for tests of checkpoints, and the error with which reading ends.
#pragma once

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

namespace carrom::test {

/// A folder of all ranks, removed at the end.
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

/// A disc with unusual numbers: a state may contain any value of a double.
inline DiscState odd_disc(DiscId id) {
    std::mt19937_64 random(id + 1);
    DiscState disc;
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

inline double odd_spin(DiscId id) {
    return id % 3 == 0
               ? -0.0
               : std::ldexp(static_cast<double>(std::mt19937_64(id + 77)() >> 11), -55) - 0.1;
}

inline SideColumns spins_of(const std::vector<DiscState>& discs) {
    std::vector<double> spins;
    for (const DiscState& disc : discs) spins.push_back(odd_spin(disc.id));
    SideColumns columns;
    columns.add(SideColumn::spin, spins);
    return columns;
}

/// Discs 0 .. n-1 in an irregular order, distributed so that some ranks may have no disc.
inline std::vector<DiscState> share(std::uint64_t n, const Communicator& world, unsigned method) {
    std::vector<DiscState> mine;
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

inline CheckpointHeader some_header() {
    CheckpointHeader header;
    header.program_version = "0.0.1";
    header.scene_name = "a scene.toml";
    header.scene_text = "[box]\nsize = 1 # \xc3\xa4\n\n";
    header.scene_overrides = "time.steps=5\ndiscs.seed=1";
    header.scene_lines_before_discs = 3;
    header.scene_discs_follow = 1;
    header.set_box(0.1);
    header.radius = 0x1p-1000;
    header.method = "time-stepped";
    header.micro_steps = 4;
    header.sync_every = 6;
    header.step = 25;
    header.micro_steps_done = 100;
    return header;
}

inline bool same_bits(const DiscState& a, const DiscState& b) {
    const auto bits = [](double number) { return std::bit_cast<std::uint64_t>(number); };
    return a.id == b.id && bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) &&
           bits(a.vx) == bits(b.vx) && bits(a.vy) == bits(b.vy) && bits(a.tau) == bits(b.tau) &&
           a.wall_collisions == b.wall_collisions && a.pair_collisions == b.pair_collisions;
}

inline std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The text and code of the error with which reading fails, the same on every rank; empty if the
/// file can be read.
inline std::string problem_of(const std::string& path, const Communicator& world) {
    try {
        read_checkpoint(path, world);
    } catch (const CollectiveError& error) {
        return std::to_string(static_cast<int>(error.code())) + ' ' + error.what();
    } catch (const InputError& error) {
        return std::string("2 ") + error.what();
    }
    return {};
}

} // namespace carrom::test
