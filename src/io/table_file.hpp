// SPDX-License-Identifier: BSD-3-Clause
// Measured tables in one HDF5 file: a group for each table, with a data set for each column and
// the table's remarks as an attribute. Programs that read large tables need not parse text.
#pragma once

#include <span>
#include <string>

#include <carrom/measured_table.hpp>

namespace carrom {

/// Writes the tables to a new file, which replaces any file at `path`. Called on one rank. Returns
/// the problem, or an empty text.
std::string write_table_file(const std::string& path, std::span<const MeasuredTable> tables);

/// Whether a file contains tables of Carrom. Other files of that name, and files that cannot be
/// read, must not be replaced, because another program may have written them.
bool is_table_file(const std::string& path);

} // namespace carrom
