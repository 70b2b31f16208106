// SPDX-License-Identifier: BSD-3-Clause
#include "apps/measured_files.hpp"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "apps/csv_table.hpp"
#include "apps/report_file.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

std::string csv_of(const MeasuredTable& table, const std::string& scene_name) {
    std::string text = fmt::format("# {}: {}\n", plain_field(scene_name), table.name);
    for (const std::string& remark : table.remarks) text += fmt::format("# {}\n", remark);
    for (std::size_t k = 0; k < table.columns.size(); ++k)
        text += (k == 0 ? "" : ",") + table.columns[k];
    text += '\n';
    for (const std::vector<double>& row : table.rows) {
        for (std::size_t k = 0; k < row.size(); ++k)
            text += fmt::format("{}{}", k == 0 ? "" : ",", row[k]);
        text += '\n';
    }
    return text;
}

void write_tables(const Scene& scene, const std::vector<MeasuredTable>& tables,
                  const Communicator& ranks) {
    std::string failure;
    if (ranks.is_root()) {
        for (const MeasuredTable& table : tables) {
            const auto path = std::filesystem::path(scene.measurements->folder) /
                              (table.name + ".csv");
            if (failure.empty())
                failure = write_whole_file(path.string(), csv_of(table, scene.name));
        }
    }
    agree(ranks, failure.empty(), failure, ExitCode::output_failure);
}

} // namespace carrom
