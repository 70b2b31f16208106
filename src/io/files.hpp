// SPDX-License-Identifier: BSD-3-Clause
// What a file system is asked for beyond writing: room, durability, names. Each throws FileError
// where it fails.
//
// These are this rank's own calls; `on_all` and `on_root` turn what they throw into what all ranks
// know.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/errors.hpp"
#include "parallel/agreement.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// Something went wrong with a file on this rank.
class FileError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The same with the system's words for `errno`.
[[noreturn]] void fail_with_errno(const std::string& what);

/// A file descriptor that closes itself.
class Descriptor {
public:
    /// Throws FileError where it cannot be opened, and for a directory (without O_DIRECTORY), a
    /// pipe or a device.
    Descriptor(const std::string& path, int flags);
    ~Descriptor();
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return number_; }

    std::uint64_t size() const;
    /// Reads up to the end of `bytes` or of the file; returns how many.
    std::size_t read(std::span<std::byte> bytes, std::uint64_t offset) const;
    void write(std::span<const std::byte> bytes, std::uint64_t offset) const;
    void sync() const;
    /// Lets the system begin to bring to disk what is written; does not wait.
    void start_sync() const;

private:
    int number_;
};

/// Throws where the file system says that it has less room than that.
void check_room(const std::string& folder, std::uint64_t bytes);
/// Takes the blocks of a file now, so that a full disk shows now; does nothing where that is not to
/// be had.
void reserve(const std::string& path);
/// Throws where a rename to `path` would replace what is neither a plain file nor a link, such as a
/// device, a pipe or a folder, and where the system would see another name, cut at a NUL.
void refuse_special(const std::string& path);
/// Renames and makes it last: the folder is synced too.
void rename_durably(const std::string& from, const std::string& to);
/// What the names of unfinished files end in.
inline constexpr std::string_view unfinished_suffix = ".partial";

/// A file that is to be renamed. At the end it is removed by whom it belongs to, unless it was:
/// half a file takes no room on a full disk.
class UnfinishedFile {
public:
    UnfinishedFile(std::string path, bool is_mine) : path_(std::move(path)), is_mine_(is_mine) {}
    ~UnfinishedFile();
    UnfinishedFile(const UnfinishedFile&) = delete;
    UnfinishedFile& operator=(const UnfinishedFile&) = delete;
    const std::string& path() const { return path_; }

private:
    std::string path_;
    bool is_mine_;
};

/// Puts a file in the place of any other, whole or not at all. `write` makes it anew under a name
/// that nobody can guess and brings it to disk.
void replace_file(const std::string& path,
                  const std::function<void(const std::string& beside)>& write);
void replace_file(const std::string& path, const std::string& text);
/// Removes what killed writers have left in a folder. No other may be under way.
void remove_unfinished(const std::string& folder);
std::string folder_of(const std::string& path);

/// Runs `act` on every rank. If it throws FileError on any, every rank throws CollectiveError with
/// `code` and that rank's text after `path`. **Collective.** With at most one collective call in
/// `act`, no rank is left behind; should it happen all the same, the failed rank ends the run after
/// half a minute (see `agree`).
template <class Act>
void on_all(const Communicator& communicator, const std::string& path, ExitCode code,
            const Act& act) {
    std::string failure;
    try {
        act();
    } catch (const FileError& error) {
        failure = path + ": " + error.what();
    }
    agree(communicator, failure.empty(), failure, code);
}

/// The same for what rank 0 does alone. **Collective.**
template <class Act>
void on_root(const Communicator& communicator, const std::string& path, ExitCode code,
             const Act& act) {
    on_all(communicator, path, code, [&] {
        if (communicator.is_root()) act();
    });
}

} // namespace carrom
