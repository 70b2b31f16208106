// SPDX-License-Identifier: BSD-3-Clause
#include "run/measured_files.hpp"

#include <cstring>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "io/table_file.hpp"
#include "measure/hdf5_key.hpp"
#include "parallel/agreement.hpp"
#include "run/files/csv_table.hpp"
#include "run/files/report_file.hpp"

namespace carrom {

namespace {

std::string path_of(const SceneParameters& scene, const MeasuredTable& table) {
    return (std::filesystem::path(scene.measurements->folder) / (table.name + ".csv")).string();
}

std::string lines_of(const std::vector<std::vector<double>>& rows) {
    std::string text;
    for (const std::vector<double>& row : rows) {
        for (std::size_t k = 0; k < row.size(); ++k)
            text += fmt::format("{}{}", k == 0 ? "" : ",", row[k]);
        text += '\n';
    }
    return text;
}

} // namespace

std::string csv_of(const MeasuredTable& table, const std::string& scene_name) {
    const std::set<std::string> names(table.columns.begin(), table.columns.end());
    ensure(names.size() == table.columns.size(), "two columns of a table have one name");
    std::string text = fmt::format("# {}: {}\n", plain_field(scene_name), table.name);
    for (const std::string& remark : table.remarks) text += fmt::format("# {}\n", remark);
    for (std::size_t k = 0; k < table.columns.size(); ++k)
        text += (k == 0 ? "" : ",") + table.columns[k];
    return text + '\n' + lines_of(table.rows);
}

void write_tables(const SceneParameters& scene, const std::vector<MeasuredTable>& tables,
                  const Communicator& ranks) {
    std::string failure;
    if (ranks.is_root()) {
        for (const MeasuredTable& table : tables) {
            if (failure.empty() && !table.grows)
                failure = write_whole_file(path_of(scene, table), csv_of(table, scene.name));
        }
        if (failure.empty() && hdf5_setting.of(*scene.measurements) != 0)
            failure = write_table_file(
                (std::filesystem::path(scene.measurements->folder) / "tables.h5").string(), tables);
    }
    agree(ranks, failure.empty(), failure, ExitCode::output_failure);
}

/// Appends new rows to the table's file. Returns the problem, or an empty text.
std::string GrowingFiles::add_rows(const MeasuredTable& rows) {
    const std::string path = path_of(scene_, rows);
    const std::string text = n_written_ == 0 ? csv_of(rows, scene_.name) : lines_of(rows.rows);
    std::uint64_t& size = sizes_[path];
    if (n_written_ == 0) {
        size = text.size();
        return write_whole_file(path, text);
    }
    if (!has_size(path, size))
        return path + " was changed, removed or replaced while the run wrote there; move it away, "
                      "then go on by --resume";
    size += text.size();
    const int error = append_whole(path, text);
    return error == 0 ? "" : "cannot write " + path + ": " + std::strerror(error);
}

void GrowingFiles::add_rows_of(const Sampler& sampler) {
    std::size_t n_new = 0;
    std::string failure;
    for (const MeasuredTable& rows : sampler.rows_from(n_written_)) {
        n_new = rows.rows.size();
        if (ranks_.is_root() && failure.empty()) failure = add_rows(rows);
    }
    if (n_new == 0) return;
    agree(ranks_, failure.empty(), failure, ExitCode::output_failure);
    n_written_ += n_new;
}

} // namespace carrom
