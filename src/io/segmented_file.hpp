// SPDX-License-Identifier: BSD-3-Clause
// A recording that grows while a run goes on: rows in segment files, joined by one small file.
//
// Readers open run/trajectory.h5. Its columns are HDF5 virtual datasets over the segments
// run/trajectory/0001.h5, 0002.h5 and so on. A segment gets its whole structure and space when it
// is made. Later, numbers are written there without HDF5, because HDF5 would rewrite the
// superblock, and a kill could damage it.
//
// A commit syncs the numbers to disk and replaces the small file by rename. The small file contains
// the number of valid rows and checksums of all bytes; its own checksum follows its last byte,
// where HDF5 does not read. Readers need no lock. Each segment is twice as large as the one before;
// its unused part takes no space on disk. Only rank 0 has the file; all ranks throw its errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/files.hpp"
#include "io/hdf5.hpp"
#include "io/segments.hpp"

namespace carrom {

/// A column. `row` is the number of components along each axis of a row; a row is one number if
/// `row` is empty.
struct RecordedColumn {
    std::string path;         ///< path of the data set in the file that readers open
    hid_t type;               ///< type of 4 or 8 bytes, little-endian, also in memory
    std::vector<hsize_t> row; ///< shape of a row: {} or {discs} or {discs, components}
    std::string unit = {};    ///< unit of the numbers, if known (h5md.hpp)
};

class SegmentedFile {
public:
    /// Makes the groups and data sets of the small file that are not columns.
    using Build = std::function<void(hid_t file)>;

    /// `communicator` must outlive this.
    SegmentedFile(const std::string& path, std::vector<RecordedColumn> columns, Build build,
                  const Communicator& communicator);

    /// Makes a new file without rows, which replaces any other. If this or another collective call
    /// fails, every rank throws CollectiveError (exit code 4), and the file is as it was at the
    /// last commit. **Collective.**
    void begin();

    /// Continues an existing file after `check` has accepted it, cut back to the rows whose number
    /// in the column `step` is at most `last`. Returns false if there is no file. Reads all bytes;
    /// throws with exit code 2 if columns differ or a byte is damaged. Changes nothing on disk: the
    /// next commit does, and must come before rows are added. **Collective.**
    bool go_on(const std::string& step, std::int64_t last,
               const std::function<void(hid_t file)>& check);

    /// Makes the rows so far permanent and visible to readers. **Collective.**
    void commit();

    /// Runs `act`, one of the operations that add rows, on rank 0 alone. `finish_addition` throws
    /// its errors later, because rank 0 must first receive everything that other ranks send.
    template <class Act> void attempt(const Act& act) {
        if (!communicator_.is_root() || !failure_.empty()) return;
        try {
            act();
        } catch (const FileError& error) {
            failure_ = error.what();
        }
    }
    /// Throws the error of an `attempt`, if any, on every rank. **Collective.**
    void finish_addition();

    /// The number of rows, at least 1, that can be written before the next `add`. May make a
    /// segment.
    std::uint64_t room();
    /// Writes numbers of a column's next rows. `add` then makes these rows valid, for all columns
    /// together.
    void write(std::size_t column, std::span<const std::byte> numbers);
    void add(std::uint64_t n_rows);

    std::uint64_t n_rows() const { return n_rows_; }
    const std::vector<FileSegment>& segments() const { return index_.segments; }

private:
    void take_over(const std::string& step, std::int64_t last,
                   const std::function<void(hid_t file)>& check);
    void refuse_segments() const;
    void make_segment();
    void check_columns(hid_t file, const Index& index) const;
    void cut(std::uint64_t n_rows);
    void open_segment();
    void sync_segment() const;
    void refuse_other_file() const;
    void commit_here();
    void write_virtual(hid_t file, const RecordedColumn& column) const;

    std::string path_;
    std::vector<RecordedColumn> columns_;
    Build build_;
    const Communicator& communicator_;
    Index index_;
    std::uint64_t n_rows_ = 0;
    bool is_cut_ = false;                ///< whether rows were cut off since the last commit
    ColumnHashers hashers_;              ///< hashes of the last segment's columns
    std::vector<std::uint64_t> written_; ///< bytes written to each column since the last `add`
    /// The last segment. It stays open, so that writes never reach another file of this name.
    std::unique_ptr<Descriptor> open_;
    std::uint64_t open_size_ = 0; ///< full size of the last segment in bytes, which does not change
    /// Checksum of the small file, once this object has written or read it
    std::optional<StateHash> seal_;
    std::string failure_;
};

} // namespace carrom
