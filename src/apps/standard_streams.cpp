// SPDX-License-Identifier: BSD-3-Clause
#include "apps/standard_streams.hpp"

#include <csignal>

#include <fcntl.h>
#include <unistd.h>

namespace carrom {

void keep_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(stream, F_GETFD) != -1) continue;
        // The lowest free number is this one: those below are open.
        if (open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) == -1) break;
    }
    std::signal(SIGPIPE, SIG_IGN);
}

} // namespace carrom
