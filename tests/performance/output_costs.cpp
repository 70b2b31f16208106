// SPDX-License-Identifier: BSD-3-Clause
// The cost of a checkpoint and of a frame of a trajectory on many ranks, counted and not timed:
// messages, bytes, calls that involve all ranks, and how often all ranks together open the written
// file. Each rank has discs with ids of the whole range, as in a run.
//   output_costs DISCS FOLDER        the files in FOLDER are removed again
#include <atomic>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "core/errors.hpp"
#include "io/checkpoint.hpp"
#include "io/start_io.hpp"
#include "io/trajectory.hpp"
#include "parallel/communicator.hpp"
#include "parallel/mpi.hpp"

namespace {

constexpr std::string_view file_name = "counted_output";
std::atomic<std::uint64_t> n_opened = 0, n_opened_to_write = 0;

int open_counted(const char* path, int flags, unsigned mode) {
    if (std::string_view(path).find(file_name) != std::string_view::npos) {
        ++n_opened;
        if ((flags & O_ACCMODE) != O_RDONLY) ++n_opened_to_write;
    }
    return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

unsigned mode_of(int flags, std::va_list arguments) {
    return (flags & O_CREAT) != 0 ? va_arg(arguments, unsigned) : 0;
}

} // namespace

// These functions replace those of the C library, also for HDF5 and for MPI-IO.
extern "C" int open(const char* path, int flags, ...) {
    std::va_list arguments;
    va_start(arguments, flags);
    const unsigned mode = mode_of(flags, arguments);
    va_end(arguments);
    return open_counted(path, flags, mode);
}
extern "C" int open64(const char* path, int flags, ...) {
    std::va_list arguments;
    va_start(arguments, flags);
    const unsigned mode = mode_of(flags, arguments);
    va_end(arguments);
    return open_counted(path, flags, mode);
}

using namespace carrom;

namespace {

/// Each rank has every n-th disc, for n ranks.
std::vector<DiscState> own_discs(std::uint64_t n_discs, const Communicator& world) {
    std::vector<DiscState> discs;
    for (auto id = static_cast<std::uint64_t>(world.rank()); id < n_discs;
         id += static_cast<std::uint64_t>(world.size())) {
        DiscState& disc = discs.emplace_back();
        disc.id = id;
        disc.x = static_cast<double>(id) / 3;
        disc.y = static_cast<double>(id) / 7;
    }
    return discs;
}

/// Prints the cost of `write`. **Collective.**
template <class Write>
void count(const char* name, std::uint64_t n_discs, const Communicator& world, const Write& write) {
    n_opened = n_opened_to_write = 0;
    const Traffic before = world.traffic();
    write();
    const Traffic after = world.traffic();
    std::uint64_t sums[] = {after.messages - before.messages, after.bytes - before.bytes, n_opened,
                            n_opened_to_write};
    world.sum(sums);
    if (world.is_root())
        std::printf(
            "%s,%llu,%d,%llu,%llu,%llu,%llu,%llu\n", name, static_cast<unsigned long long>(n_discs),
            world.size(), static_cast<unsigned long long>(sums[0]),
            static_cast<unsigned long long>(sums[1]),
            static_cast<unsigned long long>(after.collectives - before.collectives),
            static_cast<unsigned long long>(sums[2]), static_cast<unsigned long long>(sums[3]));
}

} // namespace

int main(int argc, char** argv) {
    start_io();
    const Mpi mpi(argc, argv);
    return run_on_all(Communicator::world(), [&](const Communicator& world) {
        if (argc != 3)
            throw InputError({{"output_costs", 0, "needs a number of discs and a folder"}});
        const auto n_discs = static_cast<std::uint64_t>(std::atof(argv[1]));
        const std::string path = std::string(argv[2]) + "/" + std::string(file_name);
        const std::vector<DiscState> discs = own_discs(n_discs, world);
        CheckpointHeader header;
        header.program_version = "0";
        header.method = "event-driven";
        header.set_box({1e9, 1e9});
        header.radius = 0.1;
        header.shown.n_discs = n_discs;
        header.shown.box = header.box();
        header.shown.radius = header.radius;
        TrajectoryLayout layout;
        layout.system = header.shown;
        Trajectory trajectory(path + ".h5", layout, world);
        trajectory.begin();
        if (world.is_root())
            std::printf("output,discs,ranks,messages,bytes,collectives,opens,opens_to_write\n");
        count("checkpoint", n_discs, world,
              [&] { write_checkpoint(path + ".checkpoint.h5", header, discs, world); });
        count("frame", n_discs, world, [&] { trajectory.append(0, discs, 0); });
        if (world.is_root()) {
            std::filesystem::remove(path + ".checkpoint.h5");
            std::filesystem::remove(path + ".h5");
            std::filesystem::remove_all(path);
        }
        return 0;
    });
}
