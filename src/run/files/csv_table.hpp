// SPDX-License-Identifier: BSD-3-Clause
// A new CSV table that grows line by line; each line is written as soon as it is known. Tables of
// several processes can be concatenated.
#pragma once

#include <string>

namespace carrom {

class CsvTable {
public:
    /// Throws InputError if the file exists or its path is wrong, and CollectiveError (code 4) if
    /// the disk or missing permissions prevent writing. Writes nothing before the first line.
    CsvTable(std::string path, std::string header);

    /// Throws CollectiveError (code 4) if writing fails; the table then ends before this line.
    void append(const std::string& line);

private:
    std::string path_, header_;
    bool has_begun_ = false;
};

/// The text, with ';' in place of each character that would need quotes in CSV.
std::string plain_field(std::string text);

} // namespace carrom
