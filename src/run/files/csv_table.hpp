// SPDX-License-Identifier: BSD-3-Clause
// A new table of CSV that grows line by line, each on disk as soon as it is known. Tables of
// several processes are put together by concatenation.
#pragma once

#include <string>

namespace carrom {

class CsvTable {
public:
    /// Throws InputError where there is a file already, or can be none. Nothing is written before
    /// the first line.
    CsvTable(std::string path, std::string header);

    /// Throws CollectiveError (code 4) where that fails; the table then ends with the line before.
    void append(const std::string& line);

private:
    std::string path_, header_;
    bool has_begun_ = false;
};

/// A text that needs no quotes in CSV.
std::string plain_field(std::string text);

} // namespace carrom
