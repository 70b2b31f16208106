// SPDX-License-Identifier: BSD-3-Clause
// Checksums of a checkpoint, which detect every flipped byte.
//
// They are listed in a text in the file, /carrom/checksums, whose lines are like those of
// sha256sum: one for each data set of discs, one for "all other bytes", and one for "the lines
// above".
//
// A data set's checksum is a sum over blocks of 1024 rows, modulo 2^64 in each half. Each term is
// the XXH3-128 of a block, with the block's number as seed. A sum does not depend on the order, so
// threads and ranks can hash their shares at the same time. The line before the last is the
// XXH3-128 of the file without these data sets and this text, whose offsets in the file HDF5
// reports.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/state_hash.hpp"
#include "io/hdf5.hpp"

struct XXH3_state_s;

namespace carrom {

inline constexpr const char* checksums_path = "/carrom/checksums";

/// The number of rows that are hashed at a time. The last block of a data set may be shorter.
inline constexpr std::uint64_t rows_per_block = 1 << 10;

/// The contribution of one block to its data set's checksum.
StateHash checksum_of_block(std::span<const std::byte> bytes, std::uint64_t block);

/// Replaces each of `sums` by its sum over all ranks. **Collective.**
void sum_over(const Communicator& communicator, std::span<StateHash> sums);

/// The bytes [begin, end) of a file.
struct ByteRange {
    std::uint64_t begin = 0, end = 0;
};

/// Computes the XXH3-128 of bytes that are added in several pieces.
class Hasher {
public:
    Hasher();
    void add(std::span<const std::byte> bytes);
    /// Throws FileError if the file does not have all bytes of the range.
    void add_bytes_of(const std::string& path, const ByteRange& range);
    StateHash digest() const;

private:
    struct Delete {
        void operator()(XXH3_state_s* state) const;
    };
    std::unique_ptr<XXH3_state_s, Delete> state_;
};

/// A data set with a row for each disc: where its bytes are in the file, and their checksum.
struct DiscData {
    std::string path;
    std::uint64_t rows = 0, bytes_per_row = 0;
    ByteRange place;
    StateHash checksum;
};

struct Checksums {
    std::vector<DiscData> data;
    StateHash others; ///< checksum of all other bytes of the file
    ByteRange place;  ///< where the text of checksums is in the file

    /// Returns the text of checksums. Its length does not depend on their values.
    std::string text() const;
    /// The ranges of bytes that the checksum `others` does not cover.
    std::vector<ByteRange> left_out() const;
};

/// Reads the text of checksums, and finds where the text and the data sets are in the file. Called
/// on one rank; throws FileError if the text was not written by Carrom.
Checksums read_checksums(hid_t file);

/// Whether the file's bytes contain the text of checksums or a name in /carrom/run, even if HDF5 no
/// longer finds them, because one damaged link can hide both. Only checkpoints contain them. Both
/// are searched, because they lie in different pages of the file. Reads the whole file. Called on
/// one rank; throws FileError.
bool has_traces_of_checkpoint(const std::string& path);

/// The checksum of a file without `left_out`. Called on one rank; throws FileError.
StateHash checksum_of_others(const std::string& path, std::vector<ByteRange> left_out);

/// This rank's contribution to a data set's checksum. It reads its rows through HDF5, with the
/// driver that opened the file. Not collective; throws FileError.
StateHash share_of_checksum(hid_t dataset, const DiscData& data, const Communicator& communicator);

} // namespace carrom
