// SPDX-License-Identifier: BSD-3-Clause
// A table of CSV that grows line by line, each on disk as soon as it is known. What was stopped goes on where its table
// ends; tables of several processes are put together by concatenation.
#pragma once

#include <cstddef>
#include <set>
#include <string>

namespace carrom {

class CsvTable {
public:
    /// Opens `path` to append to, and drops a line that was half written. A line's first `n_key_fields` fields tell it from
    /// others. Throws InputError where the file cannot be written or is another table.
    CsvTable(std::string path, std::string header, std::size_t n_key_fields);

    bool has(const std::string& key) const { return keys_.contains(key); }
    /// Appends `line`, which begins with its key; throws InputError where that fails. Several lines may have one key.
    void append(const std::string& line);

private:
    std::string key_in(const std::string& line) const;

    std::string path_;
    std::size_t n_key_fields_;
    std::set<std::string> keys_;
};

/// A text that needs no quotes in CSV.
std::string plain_field(std::string text);

} // namespace carrom
