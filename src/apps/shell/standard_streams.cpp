// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/standard_streams.hpp"

#include <csignal>
#include <cstdio>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "core/printable.hpp"

namespace carrom {

namespace {

void write_to_log(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

} // namespace

void keep_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(stream, F_GETFD) != -1) continue;
        // open() takes the lowest free number, which is this one: lower streams are open by now.
        if (open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) == -1) break;
    }
    std::signal(SIGPIPE, SIG_IGN);
}

void print_text(std::string_view text) { write_to_log(printable(text, true)); }

Messages messages_of(const Communicator& ranks, bool is_quiet) {
    return ranks.is_root() ? Messages(print_text, is_quiet) : Messages();
}

bool finish_standard_output() {
    const bool is_written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    pollfd output{STDOUT_FILENO, POLLOUT, 0};
    if (is_written || (poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0)) return true;
    print_text("standard output: cannot be written to\n");
    return false;
}

bool has_terminal() { return isatty(STDERR_FILENO) == 1; }

void rewrite_line(std::string_view text) {
    constexpr const char *begin = "\r", *erase_rest = "\x1b[K";
    write_to_log(begin + printable(text) + erase_rest);
}

} // namespace carrom
