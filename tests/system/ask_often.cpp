// SPDX-License-Identifier: BSD-3-Clause
// What the program ends with on a file each bit of which is flipped in turn. A process of its own
// does each command, as the program would; it is forked, because starting the program anew takes
// ten times as long.
//
//   ask_often FILE WORD... <places       WORD...: a command line of the program, as "verify FILE"
//
// Each line of standard input is a byte and a bit of FILE. The answer is a line with the exit code;
// a signal is negative.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "apps/shell/command_line.hpp"
#include "apps/shell/standard_streams.hpp"
#include "io/files.hpp"
#include "io/start_io.hpp"
#include "parallel/mpi.hpp"

using namespace carrom;

namespace {

constexpr unsigned patience_seconds = 100;

[[noreturn]] void answer(std::vector<char*> words) {
    ::alarm(patience_seconds);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
        ::dup2(::open("/dev/null", O_WRONLY), stream);
    const Action action = parse_command_line(static_cast<int>(words.size()), words.data());
    const int code = run_on_all(Communicator::world(), [&action](const Communicator& ranks) {
        const ExitCode ended = action.act(ranks);
        finish_standard_output();
        return static_cast<int>(ended);
    });
    ::_exit(code);
}

void flip(const Descriptor& file, std::uint64_t byte, unsigned bit) {
    std::byte value{};
    if (file.read(std::span(&value, 1), byte) != 1) throw FileError("has no such byte");
    value ^= std::byte{1} << bit;
    file.write(std::span(&value, 1), byte);
}

int ask(std::span<char* const> words) {
    const pid_t child = ::fork();
    if (child == 0) answer({words.begin(), words.end()});
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    start_io();
    const Mpi mpi(argc, argv, Mpi::Start::under_launcher);
    const std::string path = argv[1];
    argv[1] = argv[0]; // the program's own name comes first
    try {
        const Descriptor file(path, O_RDWR);
        for (std::uint64_t byte = 0, bit = 0; std::cin >> byte >> bit;) {
            flip(file, byte, static_cast<unsigned>(bit));
            const int code = ask(std::span(argv + 1, static_cast<std::size_t>(argc - 1)));
            flip(file, byte, static_cast<unsigned>(bit));
            std::cout << code << '\n';
        }
    } catch (const std::exception& error) {
        std::cerr << path << ": " << error.what() << '\n';
        return 1;
    }
    return 0;
}
