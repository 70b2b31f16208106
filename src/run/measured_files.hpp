// SPDX-License-Identifier: BSD-3-Clause
// Writes measured tables as CSV files: remarks after `#`, a line of column names, then numbers that
// read back with the same bits.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "measure/sampler.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

std::string csv_of(const MeasuredTable& table, const std::string& scene_name);

/// Rank 0 writes each table that does not grow, and the file tables.h5 of all tables if the scene
/// requests it. If a file cannot be written every rank throws CollectiveError, code 4.
/// **Collective.**
void write_tables(const SceneParameters& scene, const std::vector<MeasuredTable>& tables,
                  const Communicator& ranks);

/// The files of tables that grow by a line at each sample. A sample's line is in the file at the
/// end of its step. Files end with whole lines, unless the machine fails.
class GrowingFiles {
public:
    GrowingFiles(const SceneParameters& scene, const Communicator& ranks)
        : scene_(scene), ranks_(ranks) {}

    /// Rank 0 appends the rows that the files lack; the first call creates the files. Throws like
    /// `write_tables`, also if another program has changed a file. **Collective.**
    void add_rows_of(const Sampler& sampler);

private:
    std::string add_rows(const MeasuredTable& rows);

    const SceneParameters& scene_;
    const Communicator& ranks_;
    std::size_t n_written_ = 0;
    std::map<std::string, std::uint64_t> sizes_; ///< size of each file in bytes, by path, on rank 0
};

} // namespace carrom
