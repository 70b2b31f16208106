// SPDX-License-Identifier: BSD-3-Clause
// Lets a file that grows for days be cut back to where it was known to be good, whatever has
// happened since.
//
// HDF5 writes over its tables in place when a file grows; a process that is killed in between
// leaves a file that nobody can open. So what stood in a block of 4 KiB is kept beside the file
// before the block is written over for the first time since the last commit, and brought to disk.
// Rolling back puts these blocks into their places again and cuts off what came behind them. Price:
// a few blocks and as many waits for the disk per commit, nothing for bytes that are new.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_set>

namespace carrom {

class UndoJournal {
public:
    /// For the file at `path`; the journal lies beside it. Throws nothing and opens nothing yet.
    explicit UndoJournal(const std::string& path);
    ~UndoJournal();
    UndoJournal(const UndoJournal&) = delete;
    UndoJournal& operator=(const UndoJournal&) = delete;

    /// To be called before bytes are written over. Throws FileError where they cannot be kept; they
    /// must not be written over then.
    void keep(int file, std::uint64_t offset, std::uint64_t length);

    /// The file as it is now, of that size, is what to roll back to. It must be on disk.
    void commit(std::uint64_t size);

private:
    std::string path_;
    int journal_ = -1;
    std::uint64_t committed_size_ = 0;
    std::unordered_set<std::uint64_t> kept_; ///< blocks
};

/// Brings the file back to its last commit, if it has been written over since. Throws FileError.
void roll_back(const std::string& path);

} // namespace carrom
