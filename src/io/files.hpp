// SPDX-License-Identifier: BSD-3-Clause
// Calls to the file system: descriptors, free space, durability, names. Each function throws
// FileError if its call fails.
//
// Each rank calls these functions on its own. `on_all` and `on_root` turn exceptions of one rank
// into errors on all ranks.
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

/// A problem with a file on this rank.
class FileError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A problem of this machine, such as too many open files. The file itself may be undamaged, so the
/// program must not use an older file instead.
class MachineError : public FileError {
public:
    using FileError::FileError;
};

/// Throws FileError with `what` and errno's text, or MachineError if descriptors or memory have run
/// out.
[[noreturn]] void fail_with_errno(const std::string& what);

/// A file descriptor that closes itself.
class Descriptor {
public:
    /// Opens the file. Throws FileError if this fails, or if the path is a directory (without
    /// O_DIRECTORY), a pipe or a device.
    Descriptor(const std::string& path, int flags);
    ~Descriptor();
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return number_; }

    std::uint64_t size() const;
    /// Reads up to the end of `bytes` or of the file; returns the number of bytes read.
    std::size_t read(std::span<std::byte> bytes, std::uint64_t offset) const;
    void write(std::span<const std::byte> bytes, std::uint64_t offset) const;
    void sync() const;
    /// Starts writing dirty pages to disk, and returns before they are written.
    void start_sync() const;

private:
    int number_ = -1;
};

/// Whether the path still leads to the open file with descriptor `number`, and not to another one.
bool leads_to(const std::string& path, int number);
/// Throws MachineError unless this process may open as many more files as HDF5 and MPI-IO need for
/// a file with this many parts. Otherwise HDF5 and MPI-IO would fail without giving a reason, and
/// HDF5 would return fill values for parts that it cannot open.
void require_free_files(std::size_t n_parts = 0);

/// Throws if the folder does not exist, or its file system reports less free space than `bytes`.
void check_room(const std::string& folder, std::uint64_t bytes);
/// Allocates the blocks of a file, so that a full disk is an error now and not later. Does nothing
/// if the file system cannot do this.
void reserve(const std::string& path);
/// Throws if a rename to `path` would replace a device, a pipe or a folder (not a plain file or a
/// link), if the path is empty, or if it contains a NUL, where the system would cut it off.
void refuse_special(const std::string& path);
/// Holds open the folder to which `path` leads at construction. While this object exists,
/// `rename_durably` renames files below `path` in that folder only, even if something else has
/// taken its name. Not thread-safe.
class HeldFolder {
public:
    explicit HeldFolder(const std::string& path);
    ~HeldFolder();
    HeldFolder(const HeldFolder&) = delete;
    HeldFolder& operator=(const HeldFolder&) = delete;

private:
    int number_;
};

/// Renames a file, and syncs the folder so that the new name is on disk. Throws if this fails, or
/// if a HeldFolder exists for the folder and its path now leads to another folder.
void rename_durably(const std::string& from, const std::string& to);
/// The names of unfinished files end with this.
inline constexpr std::string_view unfinished_suffix = ".partial";

/// A file that will be renamed when it is complete. If it was not renamed and `is_mine`, the
/// destructor removes it, because an incomplete file is useless and takes space.
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

/// Returns a random name, which cannot be predicted. If a program is killed, `remove_unfinished`
/// removes its files with such names.
std::string name_beside();
/// Replaces a file by a new one, completely or not at all. `write` makes the new file under a
/// random name and syncs it to disk.
void replace_file(const std::string& path,
                  const std::function<void(const std::string& beside)>& write);
void replace_file(const std::string& path, const std::string& text);
/// Removes the files that killed writers have left in a folder. No other writer may be running.
void remove_unfinished(const std::string& folder);
std::string folder_of(const std::string& path);

/// The text of an error, with advice if the limit of open files is too low.
std::string with_remedy(const FileError& error);
/// The error's text after `path`, with advice. If the cause is this machine, `code` changes from
/// bad_input to collective_failure, because the input may be correct.
std::string described(const FileError& error, const std::string& path, ExitCode& code);

/// Runs `act` on every rank. If it throws FileError on any rank, every rank throws CollectiveError
/// with `code` and that rank's text after `path`; see `described`. **Collective.** If `act` makes
/// at most one collective call, no rank waits for ever. If a rank does wait, the failed rank ends
/// the run after half a minute (see `agree`).
template <class Act>
void on_all(const Communicator& communicator, const std::string& path, ExitCode code,
            const Act& act) {
    std::string failure;
    try {
        act();
    } catch (const FileError& error) {
        failure = described(error, path, code);
    }
    agree(communicator, failure.empty(), failure, code);
}

/// Runs `act` on rank 0 only, and fails on all ranks like on_all. **Collective.**
template <class Act>
void on_root(const Communicator& communicator, const std::string& path, ExitCode code,
             const Act& act) {
    on_all(communicator, path, code, [&] {
        if (communicator.is_root()) act();
    });
}

} // namespace carrom
