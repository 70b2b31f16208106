// SPDX-License-Identifier: BSD-3-Clause
#include "core/plain_file.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace carrom {

namespace {

std::ifstream failed_stream() {
    std::ifstream stream;
    stream.setstate(std::ios::failbit);
    return stream;
}

/// The reason why this file descriptor is not an open plain file; empty if it is.
OpenProblem problem_of(int number) {
    struct stat status{};
    if (number < 0 || ::fstat(number, &status) != 0)
        return {"cannot be opened: " + std::generic_category().message(errno)};
    if (S_ISDIR(status.st_mode)) return {"is a directory, not a file", true};
    if (!S_ISREG(status.st_mode)) return {"is not a plain file", false, true};
    return {};
}

} // namespace

std::ifstream open_plain_file(const std::string& path, OpenProblem& problem) {
    problem = {};
    if (path.find('\0') != std::string::npos) {
        problem.text = "is no file's name";
        return failed_stream();
    }
    const int number = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    const bool is_socket = number < 0 && errno == ENXIO;
    problem = is_socket ? OpenProblem{"is not a plain file", false, true} : problem_of(number);
    std::ifstream stream;
    if (problem.text.empty()) {
        // Opens the tested file by its descriptor; by now its name may refer to another file.
        stream.open("/proc/self/fd/" + std::to_string(number), std::ios::binary);
        if (!stream) problem = {"cannot be opened: " + std::generic_category().message(errno)};
    }
    if (number >= 0) ::close(number);
    return problem.text.empty() ? std::move(stream) : failed_stream();
}

std::ifstream open_plain_file(const std::string& path) {
    OpenProblem ignored;
    return open_plain_file(path, ignored);
}

} // namespace carrom
