// SPDX-License-Identifier: BSD-3-Clause
// A recording that grows while a run goes on: rows in segment files, joined by one small file.
//
// Readers open run/trajectory.h5. Its columns are HDF5 virtual datasets over the segments
// run/trajectory/0001.h5, 0002.h5 and so on. A segment gets all its structure and room when it is
// made. Later only numbers are written, to the places that HDF5 has given them. HDF5 itself never
// opens it to write again: it would rewrite its superblock, which a kill could damage.
//
// A commit brings the numbers to disk and replaces the small file by rename. The small file says
// how many rows count and has checksums of all their bytes and of the segments' structure. Its own
// checksum stands behind its last byte, where HDF5 does not look. Rows that came after the last
// commit are written again. Readers need no lock: what they see does not change.
//
// Segments double in size, so they are few. Room that is not yet used takes no space on disk.
// These are calls of one rank; all throw FileError.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/state_hash.hpp"
#include "io/files.hpp"
#include "io/hdf5.hpp"
#include "io/segments.hpp"

namespace carrom {

/// A row has `row` numbers along each axis; one number where there is no axis.
struct RecordedColumn {
    std::string path;         ///< of the dataset in the file that readers open
    hid_t type;               ///< of numbers of 4 or 8 bytes, little-endian, also in memory
    std::vector<hsize_t> row; ///< {} or {discs} or {discs, components}

    std::uint64_t n_cells() const { return row.empty() ? 1 : row[0]; }
    std::uint64_t bytes_per_cell() const;
};

class SegmentedFile {
public:
    /// Makes all of the small file that is no column, and their groups.
    using Build = std::function<void(hid_t file, std::uint64_t n_rows)>;

    SegmentedFile(const std::string& path, std::vector<RecordedColumn> columns, Build build);
    /// A new one, without rows, in the place of any other. Committed.
    void create();

    /// Goes on with what is there, after `check` has looked at it: cut back to the rows whose
    /// number in the column `step` is up to `last`. The columns must be the same. What is written
    /// to next is checked. Nothing changes on disk before a commit, which must come first.
    void go_on(const std::string& step, std::int64_t last,
               const std::function<void(hid_t file)>& check);

    std::uint64_t n_rows() const { return n_rows_; }
    const std::vector<Segment>& segments() const { return segments_; }

    /// The next rows, or cells [begin, begin + count) of the next row; parts begin at multiples of
    /// `cells_per_part`. They count once `add` has said so, for all columns together.
    void write(std::size_t column, std::uint64_t begin, std::uint64_t count,
               std::span<const std::byte> numbers);
    /// How many rows can be written before the next `add`, at least 1. Makes a segment if need be.
    std::uint64_t room();
    void add(std::uint64_t n_rows);

    /// What goes wrong in an `attempt` is thrown by `close`: a rank that writes what others send
    /// goes on receiving till then.
    template <class Act> void attempt(const Act& act) {
        if (!failure_.empty()) return;
        try {
            act();
        } catch (const FileError& error) {
            failure_ = error.what();
        }
    }
    /// Ends an addition.
    void close();
    /// Rows so far are to stay.
    void commit();

private:
    std::string path_of(const Segment& segment) const;
    void make_segment();
    void check_columns(hid_t file) const;
    void cut(std::uint64_t n_rows);
    void remove_other_segments() const;
    void write_index(hid_t file) const;
    void write_virtual(hid_t file, const RecordedColumn& column) const;

    std::string path_;
    std::vector<RecordedColumn> columns_;
    Build build_;
    std::vector<Segment> segments_;
    std::uint64_t n_rows_ = 0;
    std::size_t first_unsynced_ = 0;   ///< among the segments
    StateHash written_;                ///< of what `write` has written since the last `add`
    std::unique_ptr<Descriptor> open_; ///< the last segment, during an addition
    std::string failure_;
};

} // namespace carrom
