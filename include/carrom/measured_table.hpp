// SPDX-License-Identifier: BSD-3-Clause
// A table of what a scene's [output.measurements] asks for.
#pragma once

#include <string>
#include <vector>

namespace carrom {

/// Shape: `rows` are all as long as `columns`. The tables, their columns and units are listed in
/// docs/reference/measurements.md.
struct MeasuredTable {
    std::string name;                 ///< "radial_distribution", "speeds", ...
    std::vector<std::string> remarks; ///< what it shows, and units
    std::vector<std::string> columns;
    std::vector<std::vector<double>> rows;
    bool grows = false; ///< by a row at each sample; its file is written as the run goes on
};

} // namespace carrom
