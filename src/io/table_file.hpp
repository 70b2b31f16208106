// SPDX-License-Identifier: BSD-3-Clause
// Measured tables in one HDF5 file: a group for each table, with a data set for each column and
// the table's remarks as an attribute. Programs that read large tables need not parse text.
#pragma once

#include <span>
#include <string>

#include <carrom/measured_table.hpp>

namespace carrom {

/// Replaces `path` by a whole file, from one process. Returns the problem, or empty.
std::string write_table_file(const std::string& path, std::span<const MeasuredTable> tables);

/// Whether a file is one of tables. Others of that name are somebody's, as those are that cannot be
/// read.
bool is_table_file(const std::string& path);

} // namespace carrom
