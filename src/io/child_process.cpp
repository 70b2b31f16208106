// SPDX-License-Identifier: BSD-3-Clause
#include "io/child_process.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
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
/// Limit of wall time, for a child process that waits without using processor time
constexpr unsigned patience_seconds = 50;
constexpr time_t least_of_loop = 3;        ///< seconds of processor time; undamaged files take less
constexpr std::size_t longest_text = 4000; ///< bytes; a pipe accepts them in one write
constexpr int code_of_machine = 3;         ///< exit code for a MachineError in the child

void set_limit(decltype(RLIMIT_AS) kind, rlim_t most) {
    rlimit limit{};
    ::getrlimit(kind, &limit);
    limit.rlim_cur = std::min(limit.rlim_max, most);
    ::setrlimit(kind, &limit);
}

/// Sets limits, forbids core files, and restores default handlers, because the program's own
/// handlers would end all ranks.
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

[[noreturn]] void answer_and_exit(const FileError& error, int answers, int code) {
    const std::string text = std::string(error.what()).substr(0, longest_text);
    ::_exit(::write(answers, text.data(), text.size()) > 0 ? code : 2);
}

/// Inspects, and writes the problem, if there is one, to the pipe `answers`.
[[noreturn]] void inspect_and_exit(const std::function<void()>& inspect, int answers) {
    take_limits();
    try {
        inspect();
    } catch (const MachineError& error) {
        answer_and_exit(error, answers, code_of_machine);
    } catch (const FileError& error) {
        answer_and_exit(error, answers, 1);
    } catch (...) {
        ::_exit(2);
    }
    ::_exit(0);
}

} // namespace

void inspect_in_child_first(const std::function<void()>& inspect) {
    int ends[2];
    if (::pipe(ends) != 0) fail_with_errno("no pipe to a process that inspects it");
    const pid_t child = ::fork();
    if (child == 0) {
        ::close(ends[0]); // frees a file descriptor, because few may be left
        inspect_and_exit(inspect, ends[1]);
    }
    ::close(ends[1]);
    int status = 0;
    rusage used{};
    while (child > 0 && ::wait4(child, &status, 0, &used) < 0 && errno == EINTR) {
    }
    std::string answer(longest_text, 0);
    const ssize_t length = ::read(ends[0], answer.data(), answer.size());
    ::close(ends[0]);
    if (child < 0) throw MachineError("no process that inspects it can be started");
    // On a busy machine the alarm may come before an endless loop has used its processor time.
    const bool has_waited = used.ru_utime.tv_sec + used.ru_stime.tv_sec < least_of_loop;
    if (WIFSIGNALED(status) &&
        (WTERMSIG(status) == SIGKILL || (WTERMSIG(status) == SIGALRM && has_waited)))
        throw MachineError("the process that inspects it was killed, perhaps for want of memory, "
                           "or waited for the disk too long; try again");
    answer.resize(length > 0 ? static_cast<std::size_t>(length) : 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == code_of_machine) throw MachineError(answer);
    if (!answer.empty()) throw FileError(answer);
    if (status != 0)
        throw FileError("is damaged: HDF5 crashes on it, or takes too much time or memory");
    inspect();
}

} // namespace carrom
