// SPDX-License-Identifier: BSD-3-Clause
#include "scene/line_reader.hpp"

#include <algorithm>
#include <cstring>

namespace carrom {

namespace {
constexpr std::size_t block = std::size_t{1} << 18;
}

LineReader::LineReader(std::istream& stream, std::int64_t lines_before, std::uint64_t n_bytes)
    : stream_(stream), buffer_(block), line_number_(lines_before), bytes_left_(n_bytes) {}

bool LineReader::next(std::string_view& line) {
    if (is_cut_) skip_rest_of_line();
    if (is_endless_ || bytes_left_ == 0) return false;
    std::size_t searched = 0;
    for (;;) {
        const std::size_t available = end_ - begin_;
        const std::size_t length = find_line_end(searched);
        if (length < available || available > longest_line) {
            is_cut_ = length > longest_line;
            line = {buffer_.data() + begin_, std::min(length, longest_line)};
            take(is_cut_ ? longest_line : length + 1);
            break;
        }
        searched = available;
        if (refill()) continue;
        if (available == 0) return false;
        line = {buffer_.data() + begin_, available}; // the last line, which has no line end
        take(available);
        break;
    }
    line_number_ += 1;
    return true;
}

void LineReader::take(std::size_t n_bytes) {
    begin_ += n_bytes;
    bytes_left_ -= std::min<std::uint64_t>(n_bytes, bytes_left_);
}

/// The length of the next line in the buffer, or of all unread text if that has no line end. The
/// first `searched` characters are known to have no line end.
std::size_t LineReader::find_line_end(std::size_t searched) const {
    const char* first = buffer_.data() + begin_;
    const std::size_t available = end_ - begin_;
    if (searched == available) return available;
    const void* found = std::memchr(first + searched, '\n', available - searched);
    return found ? static_cast<std::size_t>(static_cast<const char*>(found) - first) : available;
}

void LineReader::skip_rest_of_line() {
    is_cut_ = false;
    for (std::size_t skipped = 0; !is_endless_; is_endless_ = skipped > most_skipped) {
        const std::size_t length = find_line_end(0);
        if (length < end_ - begin_) {
            take(length + 1);
            return;
        }
        skipped += length;
        take(length);
        if (!refill()) return;
    }
}

bool LineReader::refill() {
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
              buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
    end_ -= begin_;
    begin_ = 0;
    stream_.read(buffer_.data() + end_, static_cast<std::streamsize>(buffer_.size() - end_));
    const auto count = static_cast<std::size_t>(stream_.gcount());
    end_ += count;
    return count > 0;
}

} // namespace carrom
