// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/data_output.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace carrom {

namespace {

/// Whether an open file is a regular file that has not been removed.
bool is_named_file(int file) {
    struct stat status{};
    return ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink > 0;
}

} // namespace

DataOutput::DataOutput(const std::string& path)
    : name_(path.empty() ? "standard output" : path), file_(STDOUT_FILENO),
      is_ours_(!path.empty()) {
    std::signal(SIGPIPE, SIG_IGN);
    if (!is_ours_) return;
    file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file_ < 0) fail_with(errno);
    is_named_file_ = is_named_file(file_);
}

DataOutput::~DataOutput() { close(); }

void DataOutput::fail_with(int error) {
    if (failure_.empty()) failure_ = "cannot write to " + name_ + ": " + std::strerror(error);
}

void DataOutput::flush_if_full() {
    if (buffer_.size() >= full) flush();
}

void DataOutput::flush() {
    const char* next = buffer_.data();
    std::size_t left = buffer_.size();
    while (left > 0 && failure_.empty()) {
        const ssize_t written = ::write(file_, next, left);
        if (written >= 0) {
            next += written;
            left -= static_cast<std::size_t>(written);
        } else if (errno == EAGAIN) { // another process has made the pipe non-blocking, so wait
                                      // until there is space
            pollfd room{file_, POLLOUT, 0};
            ::poll(&room, 1, -1);
        } else if (errno != EINTR) {
            fail_with(errno);
        }
    }
    buffer_.clear();
}

void DataOutput::close() {
    if (file_ >= 0 && is_named_file_ && !is_named_file(file_) && failure_.empty())
        failure_ = name_ + ": was removed while it was written";
    if (is_ours_ && file_ >= 0 && ::close(file_) != 0) fail_with(errno);
    file_ = -1;
}

WriteProblem write_problem_of_stream(const std::string& path) {
    // Pipes are not opened, because a waiting reader would take the closing for the end of the
    // file.
    if (struct stat status{}; ::stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode))
        return ::access(path.c_str(), W_OK) == 0 ? WriteProblem{}
                                                 : write_problem("cannot be written", errno);
    int file = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    const bool is_new = file < 0 && errno == ENOENT;
    if (is_new) file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) return write_problem("cannot be written", errno);
    ::close(file);
    if (is_new) ::unlink(path.c_str());
    return {};
}

} // namespace carrom
