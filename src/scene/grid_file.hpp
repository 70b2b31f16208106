// SPDX-License-Identifier: BSD-3-Clause
// Reads text files with rows of numbers, as spreadsheets and numpy.savetxt write them.
#pragma once

#include <cstddef>
#include <string>

namespace carrom {

/// Reads rows of numbers that are separated by blanks or commas. Empty lines and text after a # are
/// ignored. Returns text such as "[[1, 2], [3, 4]]". Throws InputError with the line if the file
/// cannot be read, a word is not a finite number, rows differ in length, or the file has more than
/// `most` numbers.
std::string read_rows(const std::string& path, std::size_t most);

} // namespace carrom
