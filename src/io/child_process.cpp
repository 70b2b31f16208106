// SPDX-License-Identifier: BSD-3-Clause
#include "io/child_process.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <fstream>
#include <new>
#include <string>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/errors.hpp"
#include "io/files.hpp"

namespace carrom {

namespace {

constexpr rlim_t most_seconds = 10, most_memory = rlim_t{4} << 30;
constexpr unsigned patience_seconds = 50;  ///< for what waits without using the processor
constexpr std::size_t longest_text = 4000; ///< a pipe takes that much at once

void set_limit(decltype(RLIMIT_AS) kind, rlim_t most) {
    rlimit limit{};
    ::getrlimit(kind, &limit);
    limit.rlim_cur = std::min(limit.rlim_max, most);
    ::setrlimit(kind, &limit);
}

/// Nothing that is called here may speak for the program: no handlers, no core file.
void take_limits() {
    for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM, SIGXCPU})
        ::signal(number, SIG_DFL);
    std::set_new_handler(nullptr);
    set_failure_handler([](std::string_view, const char*, int) { ::_exit(1); });
    std::uint64_t n_pages = 0;
    std::ifstream("/proc/self/statm") >> n_pages;
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_CPU, most_seconds);
    set_limit(RLIMIT_AS, n_pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + most_memory);
    ::alarm(patience_seconds);
}

/// The answer is a text that begins with `well` or `ill`; none where the child has crashed.
constexpr char well = '+', ill = '-';

[[noreturn]] void look_and_exit(const std::function<void()>& look, int answers) {
    take_limits();
    std::string answer(1, well);
    try {
        look();
    } catch (const FileError& error) {
        answer = ill + std::string(error.what()).substr(0, longest_text - 1);
    } catch (...) {
        ::_exit(1);
    }
    ::_exit(::write(answers, answer.data(), answer.size()) > 0 ? 0 : 1);
}

std::string answer_from(int answers) {
    std::array<char, longest_text> text{};
    ssize_t length = -1;
    do length = ::read(answers, text.data(), text.size());
    while (length < 0 && errno == EINTR);
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(0, length))};
}

} // namespace

void try_in_child(const std::function<void()>& look) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) fail_with_errno("no pipe to a process that looks at it");
    const pid_t child = ::fork();
    if (child == 0) look_and_exit(look, ends[1]);
    ::close(ends[1]);
    const std::string answer = child > 0 ? answer_from(ends[0]) : "";
    ::close(ends[0]);
    if (child < 0) throw FileError("no process that looks at it can be started");
    while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
    if (answer.empty())
        throw FileError("is damaged: HDF5 crashes on it, or takes too much time or memory");
    if (answer[0] == ill) throw FileError(answer.substr(1));
}

} // namespace carrom
