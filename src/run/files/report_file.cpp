// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/report_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace carrom {

namespace {

/// Writes the whole text to an open file. Returns 0 or an errno.
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

/// Makes a rename permanent: without this call a crash may undo it. Returns 0 or an errno.
int sync_folder_of(const std::string& path) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    const int file = ::open(folder.empty() ? "." : folder.c_str(),
                            O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    // Missing permission to read the folder is no error, because files can still be written to it
    if (file < 0) return errno == EACCES ? 0 : errno;
    const int error = ::fsync(file) != 0 && errno != EINVAL ? errno : 0;
    ::close(file);
    return error;
}

/// A temporary file in the folder of `path`, which is removed unless it is renamed. Creating it
/// never replaces a file or follows a link. If `number` is negative, `errno` has the reason.
class FileBeside {
public:
    explicit FileBeside(const std::string& path) {
        constexpr int most_tries = 1000;
        for (int k = 0; k < most_tries && (k == 0 || (number < 0 && errno == EEXIST)); ++k) {
            name_ = path + '.' + std::to_string(::getpid()) + '-' + std::to_string(k) + ".partial";
            number = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                            0666);
        }
        is_there_ = number >= 0;
    }
    ~FileBeside() {
        if (number >= 0) ::close(number);
        if (is_there_) ::unlink(name_.c_str());
    }
    FileBeside(const FileBeside&) = delete;
    FileBeside& operator=(const FileBeside&) = delete;

    /// This function and the next two return 0 or an errno.
    int write(const std::string& text) const {
        const int error = write_all(number, text);
        return error == 0 && ::fsync(number) != 0 ? errno : error;
    }
    int close() { return ::close(std::exchange(number, -1)) == 0 ? 0 : errno; }
    int rename_to(const std::string& path) {
        if (std::rename(name_.c_str(), path.c_str()) != 0) return errno;
        is_there_ = false;
        return sync_folder_of(path);
    }

    int number = -1;

private:
    std::string name_;
    bool is_there_ = false;
};

} // namespace

WriteProblem write_problem_of_file(const std::string& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (std::filesystem::is_directory(status)) return {"is a directory; name a file"};
    // Only plain files may be replaced, because a rename would replace a device by a plain file.
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        return {"is not a plain file"};
    const FileBeside file(path);
    return file.number < 0 ? write_problem("cannot be written", errno) : WriteProblem{};
}

std::string write_whole_file(const std::string& path, const std::string& text) {
    FileBeside file(path);
    int error = file.number < 0 ? errno : file.write(text);
    if (error == 0) error = file.close();
    if (error == 0) error = file.rename_to(path);
    return error == 0 ? "" : "cannot write " + path + ": " + std::strerror(error);
}

int append_whole(const std::string& path, const std::string& text, bool is_new) {
    const int flags = O_WRONLY | O_APPEND | O_CLOEXEC | O_NONBLOCK |
                      (is_new ? O_CREAT | O_EXCL : 0);
    const int file = ::open(path.c_str(), flags, 0666);
    if (file < 0) return errno;
    struct stat status{};
    int error = ::fstat(file, &status) != 0 ? errno : S_ISREG(status.st_mode) ? 0 : ESPIPE;
    if (error == 0) error = write_all(file, text);
    if (error != 0 && S_ISREG(status.st_mode)) // shortened, so that no part of a line stays
        static_cast<void>(::ftruncate(file, status.st_size));
    if (::close(file) != 0 && error == 0) error = errno;
    return error;
}

bool has_size(const std::string& path, std::uint64_t size) {
    std::error_code error;
    const std::uintmax_t there = std::filesystem::file_size(path, error);
    return !error && there == size;
}

} // namespace carrom
