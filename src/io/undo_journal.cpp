// SPDX-License-Identifier: BSD-3-Clause
#include "io/undo_journal.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <optional>
#include <span>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <xxhash.h>

#include "io/files.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t block_size = 4096;

/// What the journal is made of. A record that was cut short by a kill has another checksum; its
/// block was not touched.
struct Record {
    std::uint64_t file_size = 0; ///< at the last commit
    std::uint64_t offset = 0, length = 0;
    std::uint64_t checksum = 0; ///< of all else
    std::array<std::byte, block_size> bytes{};

    std::uint64_t right_checksum() const {
        const std::array<std::uint64_t, 3> head = {file_size, offset, length};
        return XXH3_64bits_withSeed(bytes.data(), bytes.size(),
                                    XXH3_64bits(head.data(), sizeof head));
    }
};

std::string journal_path(const std::string& path) { return path + ".undo"; }

} // namespace

UndoJournal::UndoJournal(const std::string& path) : path_(journal_path(path)) {}

UndoJournal::~UndoJournal() {
    if (journal_ >= 0) ::close(journal_);
}

void UndoJournal::keep(int file, std::uint64_t offset, std::uint64_t length) {
    bool is_new = false;
    const std::uint64_t end = std::min(offset + length, committed_size_);
    for (std::uint64_t block = offset / block_size; block * block_size < end; ++block) {
        if (kept_.contains(block)) continue;
        if (journal_ < 0)
            journal_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        Record record{committed_size_,
                      block * block_size,
                      std::min(block_size, committed_size_ - block * block_size),
                      0,
                      {}};
        const ssize_t n_read = ::pread(file, record.bytes.data(), record.length,
                                       static_cast<off_t>(record.offset));
        if (journal_ < 0 || n_read != static_cast<ssize_t>(record.length))
            fail_with_errno("its old bytes cannot be kept in " + path_);
        record.checksum = record.right_checksum();
        if (::write(journal_, &record, sizeof record) != static_cast<ssize_t>(sizeof record))
            fail_with_errno("its old bytes cannot be kept in " + path_);
        kept_.insert(block);
        is_new = true;
    }
    if (is_new && ::fdatasync(journal_) != 0) fail_with_errno(path_ + " cannot be brought to disk");
}

void UndoJournal::commit(std::uint64_t size) {
    if (journal_ >= 0) ::close(journal_);
    journal_ = -1;
    if (::unlink(path_.c_str()) != 0 && errno != ENOENT)
        fail_with_errno(path_ + " cannot be removed");
    committed_size_ = size;
    kept_.clear();
}

void roll_back(const std::string& path) {
    const std::string journal = journal_path(path);
    if (::access(journal.c_str(), F_OK) != 0) return;
    const Descriptor kept(journal, O_RDONLY), file(path, O_WRONLY);
    Record record;
    std::optional<std::uint64_t> size;
    for (std::uint64_t place = 0;
         kept.read(std::as_writable_bytes(std::span(&record, 1)), place) == sizeof record;
         place += sizeof record) {
        if (record.checksum != record.right_checksum() || record.length > block_size) break;
        file.write(std::span(record.bytes).first(record.length), record.offset);
        size = record.file_size;
    }
    if (size && ::ftruncate(file.number(), static_cast<off_t>(*size)) != 0)
        fail_with_errno("cannot be cut back");
    file.sync();
    if (::unlink(journal.c_str()) != 0) fail_with_errno(journal + " cannot be removed");
}

} // namespace carrom
