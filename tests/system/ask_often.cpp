// SPDX-License-Identifier: BSD-3-Clause
// What the program ends with on a file each bit of which is flipped in turn. One process gives the
// answers until it crashes, and another one goes on behind that bit: to start the program for each
// bit would take twenty times as long.
//
//   ask_often FILE WORD... <places       WORD...: a command line of the program, as "verify FILE"
//
// Each line of standard input is a byte and a bit of FILE. The answer is a line with the exit code;
// a signal is negative.
#include <algorithm>
#include <exception>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "apps/shell/command_line.hpp"
#include "apps/shell/standard_streams.hpp"
#include "io/files.hpp"
#include "io/start_io.hpp"
#include "parallel/mpi.hpp"

using namespace carrom;

namespace {

constexpr unsigned patience_seconds = 100; ///< for one answer
constexpr int not_asked = 1000;

struct Place {
    std::uint64_t byte = 0;
    unsigned bit = 0;
    std::byte whole{}; ///< what stands there
};

std::vector<Place> read_places(const Descriptor& file) {
    std::vector<Place> places;
    for (Place place; std::cin >> place.byte >> place.bit;) {
        if (file.read(std::span(&place.whole, 1), place.byte) != 1)
            throw FileError("has no such byte");
        places.push_back(place);
    }
    return places;
}

void write_at(const Descriptor& file, const Place& place, std::byte value) {
    file.write(std::span(&value, 1), place.byte);
}

int answer(const Action& action) {
    ::alarm(patience_seconds);
    return run_on_all(Communicator::world(), [&action](const Communicator& ranks) {
        const ExitCode code = action.act(ranks);
        finish_standard_output();
        return static_cast<int>(code);
    });
}

/// Answers from `first` on, into memory that the parent shares.
[[noreturn]] void answer_from(std::size_t first, const std::vector<Place>& places,
                              const Descriptor& file, std::span<int> codes, const Action& action) {
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
        ::dup2(::open("/dev/null", O_WRONLY), stream);
    for (std::size_t k = first; k < places.size(); ++k) {
        write_at(file, places[k], places[k].whole ^ (std::byte{1} << places[k].bit));
        const int code = answer(action);
        write_at(file, places[k], places[k].whole);
        codes[k] = code;
    }
    ::_exit(0);
}

/// The codes of all places. Where a process has ended before its answer, that end is the answer.
std::vector<int> ask(const std::vector<Place>& places, const Descriptor& file,
                     const Action& action) {
    void* const shared = ::mmap(nullptr, (places.size() + 1) * sizeof(int), PROT_READ | PROT_WRITE,
                                MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) fail_with_errno("no memory for answers");
    const std::span codes(static_cast<int*>(shared), places.size());
    std::fill(codes.begin(), codes.end(), not_asked);
    for (std::size_t k = 0; k < places.size(); ++k) {
        const pid_t child = ::fork();
        if (child == 0) answer_from(k, places, file, codes, action);
        int status = 0;
        ::waitpid(child, &status, 0);
        while (k < places.size() && codes[k] != not_asked) ++k;
        if (k == places.size()) break;
        codes[k] = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        write_at(file, places[k], places[k].whole);
    }
    return {codes.begin(), codes.end()};
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    start_io();
    const Mpi mpi(argc, argv, Mpi::Start::under_launcher);
    const std::string path = argv[1];
    argv[1] = argv[0]; // the program's own name comes first
    const Action action = parse_command_line(argc - 1, argv + 1);
    try {
        const Descriptor file(path, O_RDWR);
        for (const int code : ask(read_places(file), file, action)) std::cout << code << '\n';
    } catch (const std::exception& error) {
        std::cerr << path << ": " << error.what() << '\n';
        return 1;
    }
    return 0;
}
