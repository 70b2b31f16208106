// SPDX-License-Identifier: BSD-3-Clause
// Text files of numbers in rows, as a spreadsheet or numpy.savetxt writes them.
#pragma once

#include <cstddef>
#include <string>

namespace carrom {

/// Reads the rows, with numbers between blanks or commas; empty lines and what follows a # do not
/// count. Returns "[[1, 2], [3, 4]]". Throws InputError with the line if the file cannot be read,
/// a word is not a finite number, rows differ in length, or there are more than `most` numbers.
std::string read_rows(const std::string& path, std::size_t most);

} // namespace carrom
