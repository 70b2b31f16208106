// SPDX-License-Identifier: BSD-3-Clause
// Reads lines of a stream in bounded memory, so that a line without an end does not fill the
// memory.
//
// It reads whole blocks. So after the last line, the position of the stream is usually beyond the
// end of that line.
#pragma once

#include <cstdint>
#include <istream>
#include <limits>
#include <string_view>
#include <vector>

namespace carrom {

class LineReader {
public:
    static constexpr std::size_t longest_line = 4096;
    static constexpr std::size_t most_skipped = std::size_t{64} << 20;
    static constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();

    /// `lines_before`: the number of lines of the stream before this point, for line numbers. Only
    /// lines that begin in the next `n_bytes` bytes are read. The stream must outlive the reader.
    LineReader(std::istream& stream, std::int64_t lines_before, std::uint64_t n_bytes = no_limit);

    /// Sets `line` to the next line, without its line end; returns false at the end of the stream.
    /// `line` is valid until the next call. If a line is longer than `longest_line`, its rest is
    /// skipped; if the rest has more than `most_skipped` characters, no more lines are read.
    bool next(std::string_view& line);

    std::int64_t line_number() const { return line_number_; }
    bool is_cut() const { return is_cut_; }
    bool is_endless() const { return is_endless_; }   ///< `next` ended after skipping too much
    bool has_failed() const { return stream_.bad(); } ///< `next` ended because of a read error

private:
    bool refill();
    std::size_t find_line_end(std::size_t searched) const;
    void skip_rest_of_line();
    void take(std::size_t n_bytes);

    std::istream& stream_;
    std::vector<char> buffer_;
    std::size_t begin_ = 0, end_ = 0;
    std::int64_t line_number_;
    std::uint64_t bytes_left_; ///< number of bytes in which a line may still begin
    bool is_cut_ = false, is_endless_ = false;
};

} // namespace carrom
