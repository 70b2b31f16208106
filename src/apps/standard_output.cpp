// SPDX-License-Identifier: BSD-3-Clause
#include "standard_output.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <poll.h>
#include <unistd.h>

namespace carrom {

StandardOutput::StandardOutput() { std::signal(SIGPIPE, SIG_IGN); }

void StandardOutput::flush_if_full() {
    if (buffer_.size() >= full) flush();
}

void StandardOutput::flush() {
    const char* next = buffer_.data();
    std::size_t left = buffer_.size();
    while (left > 0 && failure_.empty()) {
        const ssize_t written = ::write(STDOUT_FILENO, next, left);
        if (written >= 0) {
            next += written;
            left -= static_cast<std::size_t>(written);
        } else if (errno == EAGAIN) { // someone made the pipe non-blocking: wait until there is room
            pollfd room{STDOUT_FILENO, POLLOUT, 0};
            ::poll(&room, 1, -1);
        } else if (errno != EINTR) {
            failure_ = std::string("cannot write to standard output: ") + std::strerror(errno);
        }
    }
    buffer_.clear();
}

} // namespace carrom
