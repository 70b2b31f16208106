// SPDX-License-Identifier: BSD-3-Clause
// An HDF5 file that grows while a run goes on: written by rank 0, closed between two additions so
// that others can read it meanwhile, and safe from kills by an UndoJournal.
//
// These are calls of one rank; all throw FileError. After a failure the file is as it was at the
// last commit.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/hdf5.hpp"
#include "io/undo_journal.hpp"

namespace carrom {

class AppendedFile {
public:
    using Act = std::function<void(hid_t file)>;

    explicit AppendedFile(const std::string& path) : path_(path), journal_(path) {}
    ~AppendedFile() { file_.abandon(); }
    AppendedFile(const AppendedFile&) = delete;
    AppendedFile& operator=(const AppendedFile&) = delete;
    const std::string& path() const { return path_; }

    /// A new file in the place of any other; `build` makes its structure. Committed.
    void create(const Act& build);

    /// Goes on with a file: cuts it back to its last commit. False where there is none.
    bool reopen();

    /// Opens the file to add to it, any number of times, and closes it. What goes wrong in an
    /// `attempt` is thrown by `close`: a rank that writes what others send goes on receiving till
    /// then.
    void open();
    void attempt(const Act& act);
    void close();

    /// The three in one.
    void change(const Act& act) {
        open();
        attempt(act);
        close();
    }

    /// Brings the file to disk: it will be cut back to here.
    void commit();

private:
    std::string path_;
    UndoJournal journal_;
    h5::File file_;
    std::string failure_;
};

/// A dataset whose first axis grows, 0 long at first; `row` are its other dimensions. `chunk` has
/// all of them. `level` 0 to 9: deflate.
void create_growing(hid_t parent, const char* name, hid_t type, std::span<const hsize_t> row,
                    std::span<const hsize_t> chunk, int level);

/// Sets the length of the first axis.
void set_length(hid_t parent, const char* name, hsize_t length);
hsize_t length_of(hid_t parent, const char* name);

/// Writes a block that begins at `start` and is `count` long along each axis.
void write_block(hid_t parent, const char* name, std::span<const hsize_t> start,
                 std::span<const hsize_t> count, hid_t type, const void* values);

/// How many of the ascending numbers of a dataset are <= `last`.
hsize_t count_up_to(hid_t parent, const char* name, std::int64_t last);

std::vector<std::int64_t> read_numbers(hid_t parent, const char* name);

} // namespace carrom
