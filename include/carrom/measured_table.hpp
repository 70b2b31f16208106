// SPDX-License-Identifier: BSD-3-Clause
// A table of results that the scene requests in [output.measurements].
#pragma once

#include <string>
#include <vector>

namespace carrom {

/// Each row has as many numbers as there are columns. The tables, their columns and units are
/// listed in docs/reference/measurements.md.
struct MeasuredTable {
    std::string name;                 ///< "radial_distribution", "speeds", ...
    std::vector<std::string> remarks; ///< lines that explain the table and its units
    std::vector<std::string> columns;
    std::vector<std::vector<double>> rows;
    /// Whether each sample adds a row; such rows are written to the table's file during the run
    bool grows = false;
};

} // namespace carrom
