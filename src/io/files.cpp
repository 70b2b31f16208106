// SPDX-License-Identifier: BSD-3-Clause
#include "io/files.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <random>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <fmt/format.h>

#include "io/checkpoint_folder.hpp"

namespace carrom {

namespace {

constexpr std::string_view partial_prefix = ".carrom-";

/// Whether a name is like "report.json.1234-0.partial", as write_whole_file makes in process 1234.
bool is_text_beside(std::string_view name) {
    if (!name.ends_with(unfinished_suffix)) return false;
    name.remove_suffix(unfinished_suffix.size());
    const std::size_t point = name.rfind('.');
    if (point == std::string_view::npos) return false;
    const std::string_view text = name.substr(0, point), numbers = name.substr(point + 1);
    const std::size_t dash = numbers.find('-');
    return (text.ends_with(".csv") || text.ends_with(".json")) && dash != 0 &&
           dash != std::string_view::npos && dash + 1 < numbers.size() &&
           numbers.find_first_not_of("0123456789-") == std::string_view::npos;
}

/// Whether this process can still open a file with `n_parts` parts; if not, `errno` has the reason.
bool has_free_files(std::size_t n_parts = 0) {
    constexpr std::size_t n_for_one = 8;
    std::vector<int> files;
    int error = 0;
    while (files.size() < n_for_one + n_parts && error == 0) {
        const int file = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
        file < 0 ? static_cast<void>(error = errno) : files.push_back(file);
    }
    for (const int file : files) ::close(file);
    errno = error;
    return error != EMFILE && error != ENFILE;
}

} // namespace

void fail_with_errno(const std::string& what) {
    const int error = errno;
    const std::string text = what + ": " + std::strerror(error);
    if (error == EMFILE || error == ENFILE || error == ENOMEM) throw MachineError(text);
    throw FileError(text);
}

std::string with_remedy(const FileError& error) {
    if (has_free_files()) return error.what();
    rlimit limit{};
    ::getrlimit(RLIMIT_NOFILE, &limit);
    return fmt::format("{}; this process may have only {} files open at once: raise that limit "
                       "(ulimit -n 1024), then try again",
                       error.what(), limit.rlim_cur);
}

std::string described(const FileError& error, const std::string& path, ExitCode& code) {
    const bool is_of_machine = dynamic_cast<const MachineError*>(&error) != nullptr ||
                               !has_free_files();
    if (is_of_machine && code == ExitCode::bad_input) code = ExitCode::collective_failure;
    return path + ": " + with_remedy(error);
}

// Does not wait for the other end of a pipe when it opens one; pipes are rejected afterwards.
Descriptor::Descriptor(const std::string& path, int flags) {
    if (path.find('\0') != std::string::npos) throw FileError("is no file's name");
    number_ = ::open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK, 0666);
    if (number_ < 0) fail_with_errno("cannot be opened");
    struct stat status{};
    if ((flags & O_DIRECTORY) != 0 || (::fstat(number_, &status) == 0 && S_ISREG(status.st_mode)))
        return;
    ::close(number_);
    throw FileError("is not a plain file");
}

Descriptor::~Descriptor() { ::close(number_); }

std::uint64_t Descriptor::size() const {
    struct stat status{};
    if (::fstat(number_, &status) != 0) fail_with_errno("its size cannot be had");
    return static_cast<std::uint64_t>(status.st_size);
}

std::size_t Descriptor::read(std::span<std::byte> bytes, std::uint64_t offset) const {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = ::pread(number_, bytes.data() + done, bytes.size() - done,
                                  static_cast<off_t>(offset + done));
        if (n == 0) break;
        if (n > 0)
            done += static_cast<std::size_t>(n);
        else if (errno != EINTR)
            fail_with_errno("cannot be read");
    }
    return done;
}

void Descriptor::write(std::span<const std::byte> bytes, std::uint64_t offset) const {
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t n = ::pwrite(number_, bytes.data() + done, bytes.size() - done,
                                   static_cast<off_t>(offset + done));
        if (n >= 0)
            done += static_cast<std::size_t>(n);
        else if (errno != EINTR)
            fail_with_errno("cannot be written");
    }
}

void Descriptor::sync() const {
    if (::fsync(number_) != 0) fail_with_errno("cannot be brought to disk");
}

void Descriptor::start_sync() const {
    ::sync_file_range(number_, 0, 0, SYNC_FILE_RANGE_WRITE); // only a hint; `sync` reports failures
}

bool leads_to(const std::string& path, int number) {
    struct stat open{}, named{};
    return ::fstat(number, &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
           open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

void require_free_files(std::size_t n_parts) {
    if (!has_free_files(n_parts)) fail_with_errno("cannot be opened");
}

void check_room(const std::string& folder, std::uint64_t bytes) {
    struct statvfs status{};
    if (::statvfs(folder.c_str(), &status) != 0) {
        if (errno == ENOENT)
            throw FileError(fmt::format("cannot be written, because there is no folder {}; make it "
                                        "first",
                                        folder));
        fail_with_errno("its file system cannot be asked");
    }
    const std::uint64_t room = std::uint64_t{status.f_bavail} * status.f_frsize;
    // Some file systems do not support this and report 0 of 0 free blocks.
    if (status.f_blocks > 0 && room < bytes)
        throw FileError(
            fmt::format("No space left on device: {} bytes are needed, {} are free", bytes, room));
}

void reserve(const std::string& path) {
    const Descriptor file(path, O_WRONLY);
    if (::fallocate(file.number(), 0, 0, static_cast<off_t>(file.size())) != 0 &&
        errno != EOPNOTSUPP && errno != ENOSYS && errno != EINVAL)
        fail_with_errno("its room cannot be reserved");
}

void refuse_special(const std::string& path) {
    if (path.empty() || path.find('\0') != std::string::npos) throw FileError("is no file's name");
    struct stat status{};
    if (::lstat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISLNK(status.st_mode))
        throw FileError("is not a plain file");
}

namespace {

/// Paths of all HeldFolders that exist, by their file descriptors; each path ends in a slash.
std::map<int, std::string>& held_folders() {
    static std::map<int, std::string> all;
    return all;
}

/// The part of a path after a held folder and any further slashes, as in "folder//name".
const char* below(const std::string& path, std::size_t n_letters_of_folder) {
    const std::size_t first = path.find_first_not_of('/', n_letters_of_folder);
    return path.c_str() + std::min(first, path.size());
}

} // namespace

HeldFolder::HeldFolder(const std::string& path)
    : number_(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (number_ >= 0) held_folders()[number_] = path + '/';
}

HeldFolder::~HeldFolder() {
    if (number_ < 0) return;
    held_folders().erase(number_);
    ::close(number_);
}

void rename_durably(const std::string& from, const std::string& to) {
    int folder = AT_FDCWD;
    std::string held;
    for (const auto& [number, path] : held_folders())
        if (to.starts_with(path) && from.starts_with(path)) folder = number, held = path;
    // If another folder has taken the name of the held folder, `from` is in that other folder, so
    // the rename fails.
    const std::size_t n = held.size();
    const bool is_done = ::renameat(folder, held.empty() ? from.c_str() : below(from, n), folder,
                                    held.empty() ? to.c_str() : below(to, n)) == 0;
    const int reason = errno;
    if (!held.empty() && (!leads_to(held, folder) || (!is_done && reason == ENOENT)))
        throw FileError("its folder, or its newest part, was moved, removed or replaced while the "
                        "run wrote there; bring it back, then go on by --resume");
    errno = reason;
    if (!is_done) fail_with_errno("cannot be renamed");
    Descriptor(folder_of(to), O_RDONLY | O_DIRECTORY).sync();
}

UnfinishedFile::~UnfinishedFile() {
    if (is_mine_) ::unlink(path_.c_str());
}

std::string name_beside() {
    std::random_device random;
    return fmt::format("{}{:08x}{:08x}{}", partial_prefix, random(), random(), unfinished_suffix);
}

void replace_file(const std::string& path,
                  const std::function<void(const std::string& beside)>& write) {
    refuse_special(path);
    const UnfinishedFile beside((std::filesystem::path(folder_of(path)) / name_beside()).string(),
                                true);
    write(beside.path());
    rename_durably(beside.path(), path);
}

void replace_file(const std::string& path, const std::string& text) {
    replace_file(path, [&text](const std::string& beside) {
        const Descriptor file(beside, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW);
        file.write(std::as_bytes(std::span(text)), 0);
        file.sync();
    });
}

void remove_unfinished(const std::string& folder) {
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!name.ends_with(unfinished_suffix)) continue;
        const std::string whole = name.substr(0, name.size() - unfinished_suffix.size());
        if (name.starts_with(partial_prefix) || is_named_as_checkpoint(whole) ||
            is_text_beside(name))
            ::unlink(entry->path().c_str());
    }
}

std::string folder_of(const std::string& path) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

} // namespace carrom
