// SPDX-License-Identifier: BSD-3-Clause
// Reads files in which bytes have been replaced anywhere, even in HDF5's own metadata: checkpoints
// with correct checksums (as if forged), trajectories, logs of collisions, and recordings that a
// run continues. Each file is read in a separate process with 4 GB of memory and ten
// seconds.
//   damaged_files COUNT [SEED [KIND]]      COUNT files of each kind; prints the numbers of those
//                                          that have failed
//   damaged_files 1 SEED KIND              only this file, which is left at the printed path
// Each file must be read or give an error. A crash within HDF5 must also end in an error, and is
// counted. Exit code 1 after a crash, another exception, or more memory or time than allowed.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <mpi.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/errors.hpp"
#include "io/checkpoint.hpp"
#include "io/collision_log.hpp"
#include "io/frame_file.hpp"
#include "io/start_io.hpp"
#include "io/trajectory.hpp"
#include "parallel/mpi.hpp"
#include "sample_files.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr rlim_t most_memory = rlim_t{4} << 30;
constexpr rlim_t most_seconds = 10;
enum Ending { is_read = 0, is_refused = 2, is_refused_in_a_crash = 3, has_thrown = 50 };

/// The path of the file, which the first process and its child processes use.
const std::string& path() {
    static const std::string name = "/dev/shm/carrom_damaged_" + std::to_string(::getpid()) + ".h5";
    return name;
}

/// Reads everything that `carrom verify`, `info`, `convert` and a restart would.
void read_all(const std::string& file_path, const Communicator& world) {
    check_damage(file_path, world);
    const FrameFile file(file_path);
    const FileSummary& summary = file.summary();
    Rows rows;
    if (summary.kind == FileKind::checkpoint) static_cast<void>(read_checkpoint(file_path, world));
    constexpr std::uint64_t at_a_time = 1 << 14;
    const std::size_t n_frames = summary.kind == FileKind::collisions ? 1 : summary.steps.size();
    for (std::size_t frame = 0; frame < n_frames; ++frame)
        for (std::uint64_t begin = 0; begin < summary.n_rows; begin += at_a_time)
            file.read(frame, begin, std::min(begin + at_a_time, summary.n_rows), rows);
}

struct Kind {
    const char* name;
    std::vector<char> whole;
    std::optional<Forger> forger;
    std::function<void(const std::string&)> read;
};

/// The places of non-empty bytes, because most of a small file is empty space between its data
/// sets.
std::vector<std::size_t> places_in(const Kind& kind) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < kind.whole.size(); ++i) {
        const std::size_t from = i > 8 ? i - 8 : 0, to = std::min(i + 8, kind.whole.size());
        if (std::any_of(kind.whole.begin() + static_cast<std::ptrdiff_t>(from),
                        kind.whole.begin() + static_cast<std::ptrdiff_t>(to),
                        [](char c) { return c != 0; }))
            places.push_back(i);
    }
    return places;
}

/// Replaces one to four places by a random byte, a flipped bit, eight bytes of a number that may
/// cause errors, or bytes from elsewhere.
std::vector<char> damaged(const Kind& kind, const std::vector<std::size_t>& places,
                          Random& random) {
    std::vector<char> bytes = kind.whole;
    for (std::size_t n = 1 + random.index(4); n > 0; --n) {
        const std::size_t place = places[random.index(places.size())],
                          room = std::min<std::size_t>(8, bytes.size() - place);
        const std::array<std::uint64_t, 7> numbers = {0,
                                                      ~std::uint64_t{0},
                                                      std::uint64_t{1} << 63,
                                                      std::uint64_t{1} << 31,
                                                      0xffffffff,
                                                      place,
                                                      4096};
        const std::uint64_t number = numbers[random.index(numbers.size())];
        switch (random.index(4)) {
        case 0: bytes[place] = static_cast<char>(random.index(256)); break;
        case 1: bytes[place] = static_cast<char>(bytes[place] ^ (1 << random.index(8))); break;
        case 2:
            std::memcpy(&bytes[place], &number, std::min(room, std::size_t{1} << random.index(4)));
            break;
        default:
            std::memmove(&bytes[place],
                         &bytes[places[random.index(places.size())] & ~std::size_t{7}], room);
            break;
        }
    }
    return bytes;
}

/// Reads the file in a child process, and ends this process.
[[noreturn]] void read_and_exit(const Kind& kind) {
    const rlimit memory = {most_memory, most_memory}, time = {most_seconds, most_seconds};
    ::setrlimit(RLIMIT_AS, &memory);
    ::setrlimit(RLIMIT_CPU, &time);
    ::alarm(60);
    try {
        kind.read(path());
        ::_exit(is_read);
    } catch (const InputError&) {
        ::_exit(is_refused);
    } catch (const CollectiveError&) {
        ::_exit(is_refused);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        ::_exit(has_thrown);
    }
}

/// Counts the failures among `count` damaged files: files that are neither read nor give an error.
int try_kind(const Kind& kind, std::uint64_t seed, std::uint64_t count) {
    const std::vector<std::size_t> places = places_in(kind);
    int n_bad = 0, n_read = 0, n_crashed = 0;
    long most_kilobytes = 0;
    for (std::uint64_t i = seed; i < seed + count; ++i) {
        Random random(i);
        const std::vector<char> bytes = damaged(kind, places, random);
        ::unlink((path() + ".undo").c_str()); // left by a process that failed
        if (kind.forger)
            kind.forger->write(path(), bytes);
        else
            write_bytes(path(), bytes);
        const pid_t child = ::fork();
        if (child == 0) read_and_exit(kind);
        int status = 0;
        rusage usage{};
        ::wait4(child, &status, 0, &usage);
        most_kilobytes = std::max(most_kilobytes, usage.ru_maxrss);
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        n_read += code == is_read;
        n_crashed += code == is_refused_in_a_crash;
        if (code == is_read || code == is_refused || code == is_refused_in_a_crash) continue;
        std::printf("%s %llu: %s %d, %ld MB\n", kind.name, static_cast<unsigned long long>(i),
                    code < 0 ? "signal" : "exit code", std::abs(code), usage.ru_maxrss / 1024);
        std::fflush(stdout);
        ++n_bad;
    }
    std::printf("%s: of %llu files %d were read, %d failed, HDF5 crashed on %d; at most %ld MB\n",
                kind.name, static_cast<unsigned long long>(count), n_read, n_bad, n_crashed,
                most_kilobytes / 1024);
    std::fflush(stdout);
    return n_bad;
}

} // namespace

/// Replaces MPI_Abort, which a forked process does not have. A crash within HDF5 ends here.
extern "C" int MPI_Abort(MPI_Comm, int code) {
    ::_exit(code == static_cast<int>(ExitCode::bad_input) ? is_refused_in_a_crash : code);
}

int main(int argc, char** argv) {
    start_io();
    Mpi mpi(argc, argv);
    const Communicator world = Communicator::world();
    const std::uint64_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100,
                        seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
    const auto read = [&](const std::string& file) { read_all(file, world); };
    std::vector<Kind> kinds;
    const auto add = [&](const char* name, const auto& write,
                         std::function<void(const std::string&)> use) {
        write();
        kinds.push_back({name, bytes_of(path()), {}, std::move(use)});
    };
    add("checkpoint", [&] { write_sample_checkpoint(path(), world); }, read);
    kinds.back().forger.emplace(path());
    add("trajectory", [&] { write_sample_trajectory(path(), false, world); }, read);
    add("compressed_trajectory", [&] { write_sample_trajectory(path(), true, world); }, read);
    add("log", [&] { write_sample_log(path(), world); }, read);
    add(
        "trajectory_to_go_on_with", [&] { write_sample_trajectory(path(), false, world); },
        [&](const std::string& file) {
            Trajectory trajectory(file, sample_layout(false), world);
            trajectory.go_on(10);
            trajectory.commit();
            trajectory.append(20, std::vector<DiscState>(12), 6);
            trajectory.commit();
        });
    add(
        "log_to_go_on_with", [&] { write_sample_log(path(), world); },
        [&](const std::string& file) {
            CollisionLog log(file, sample_layout(false).system, world);
            log.go_on(3);
            log.commit();
            log.append(std::vector<LoggedCollision>(5), 6);
            log.commit();
        });
    int n_bad = 0;
    for (const Kind& kind : kinds)
        if (argc < 4 || std::strcmp(argv[3], kind.name) == 0) n_bad += try_kind(kind, seed, count);
    if (argc > 3 && count == 1) {
        std::printf("%s\n", path().c_str());
        return n_bad;
    }
    for (const char* const ending : {"", ".undo", ".lock"}) ::unlink((path() + ending).c_str());
    return n_bad == 0 ? 0 : 1;
}
