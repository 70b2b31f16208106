// SPDX-License-Identifier: BSD-3-Clause
#include "apps/report_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <unistd.h>

namespace carrom {

namespace {

std::string partial(const std::string& path) { return path + ".partial"; }

int create(const std::string& path) {
    return ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
}

std::string error_text(const std::string& what, int error) {
    return what + ": " + std::strerror(error);
}

/// 0 or an errno.
int write_all(int file, const std::string& text) {
    for (std::size_t begin = 0; begin < text.size();) {
        const ssize_t written = ::write(file, text.data() + begin, text.size() - begin);
        if (written >= 0)
            begin += static_cast<std::size_t>(written);
        else if (errno != EINTR)
            return errno;
    }
    return 0;
}

} // namespace

std::string obstacle_to_writing(const std::string& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (std::filesystem::is_directory(status)) return "is a directory; name a file";
    // A rename would put a plain file in the place of a device or a pipe.
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        return "is not a plain file";
    const int file = create(partial(path));
    if (file < 0) return error_text("cannot be written", errno);
    ::close(file);
    ::unlink(partial(path).c_str());
    return {};
}

std::string write_whole_file(const std::string& path, const std::string& text) {
    const int file = create(partial(path));
    if (file < 0) return error_text("cannot create " + partial(path), errno);
    int error = write_all(file, text);
    if (error == 0 && ::fsync(file) != 0) error = errno;
    if (::close(file) != 0 && error == 0) error = errno;
    if (error == 0 && std::rename(partial(path).c_str(), path.c_str()) != 0) error = errno;
    if (error == 0) return {};
    ::unlink(partial(path).c_str());
    return error_text("cannot write " + path, error);
}

} // namespace carrom
