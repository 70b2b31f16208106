// SPDX-License-Identifier: BSD-3-Clause
// A table of CSV that grows line by line, each on disk as soon as it is known. What was stopped
// goes on where its table ends; tables of several processes are put together by concatenation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <string>

#include "io/write_lock.hpp"

namespace carrom {

class CsvTable {
public:
    /// What a line consists of: its first `n_key` fields tell it from others, its last `n_origin`
    /// say where it was measured.
    struct Layout {
        std::string header;
        std::size_t n_key = 0, n_origin = 0;
        std::string origin; ///< of the lines that are added here
    };

    /// Looks what is in the file, and drops a line that was half written; anything else that is not
    /// such a table is refused and left as it was. Nothing is written before the first line. Throws
    /// InputError, and CollectiveError (code 4) where a disk fails.
    CsvTable(std::string path, Layout layout);

    bool has(const std::string& key) const { return keys_.contains(key); }
    /// Appends a line of a key, numbers and this table's origin. Several lines may have one key.
    /// Throws CollectiveError (code 4) where that fails; the table then ends with the line before.
    void append(const std::string& key, const std::string& numbers);

    /// Lines that were there from another version, compiler or machine: their times are not
    /// comparable.
    std::size_t n_foreign() const { return n_foreign_; }

private:
    void take_in(const std::string& text);
    void write(const std::string& text);

    std::string path_;
    Layout layout_;
    std::unique_ptr<WriteLock> lock_;
    std::set<std::string> keys_;
    std::uintmax_t size_ = 0; ///< of whole lines
    std::size_t n_foreign_ = 0;
};

/// A text that needs no quotes in CSV.
std::string plain_field(std::string text);

} // namespace carrom
