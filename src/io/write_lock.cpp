// SPDX-License-Identifier: BSD-3-Clause
#include "io/write_lock.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "io/files.hpp"

namespace carrom {

namespace {

/// Tries for up to `patience` to take the lock, because a run that was just killed may still be
/// ending.
constexpr std::chrono::milliseconds patience(2000), pause(50);

std::string this_process() {
    std::array<char, 256> host{};
    ::gethostname(host.data(), host.size() - 1);
    return fmt::format("process {} on {}", ::getpid(), host.data());
}

std::string first_bytes(int file) {
    std::array<char, 512> text{};
    const ssize_t n = ::pread(file, text.data(), text.size() - 1, 0);
    return n > 0 ? std::string(text.data(), static_cast<std::size_t>(n))
                 : "a process that has not yet said which";
}

} // namespace

WriteLock::WriteLock(std::string path, MadeFolders made)
    : made_(std::move(made)), path_(std::move(path)) {
    const auto start = std::chrono::steady_clock::now();
    while (!try_once() && std::chrono::steady_clock::now() - start < patience)
        std::this_thread::sleep_for(pause);
}

WriteLock::~WriteLock() {
    if (file_ < 0) return;
    // removes the file before it releases the lock, because no other run can hold the lock then
    if (!is_lost()) ::unlink(path_.c_str());
    ::close(file_);
}

bool WriteLock::is_lost() const { return file_ >= 0 && !leads_to(path_, file_); }

WriteLock::WriteLock(WriteLock&& other) noexcept
    : made_(std::move(other.made_)), path_(std::move(other.path_)),
      holder_(std::move(other.holder_)), problem_(std::move(other.problem_)),
      file_(std::exchange(other.file_, -1)), folder_(std::move(other.folder_)) {}

/// Returns true if the lock is held, or if further waiting would be useless.
bool WriteLock::try_once() {
    holder_.clear();
    const int file = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK,
                            0666);
    if (file < 0) {
        problem_ = fmt::format("{} cannot be opened: {}", path_, std::strerror(errno));
        return true;
    }
    if (struct stat status{}; ::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) {
        problem_ = path_ + " is not a plain file";
        ::close(file);
        return true;
    }
    if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK) holder_ = first_bytes(file);
        ::close(file);
        return holder_.empty();
    }
    if (!leads_to(path_, file)) { // the former holder has removed the file
        ::close(file);
        return false;
    }
    const std::string text = this_process();
    if (::ftruncate(file, 0) == 0) [[maybe_unused]]
        const ssize_t n = ::pwrite(file, text.data(), text.size(), 0);
    file_ = file;
    folder_ = std::make_unique<HeldFolder>(folder_of(path_));
    return true;
}

} // namespace carrom
