// SPDX-License-Identifier: BSD-3-Clause
#include "apps/measured_files.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "apps/csv_table.hpp"
#include "apps/report_file.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

namespace {

std::string path_of(const Scene& scene, const MeasuredTable& table) {
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

/// All of it or nothing. Returns what went wrong, empty if nothing did.
std::string append_to(const std::string& path, const std::string& text) {
    const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    int error = file < 0 ? errno : 0;
    const off_t size = file < 0 ? 0 : ::lseek(file, 0, SEEK_END);
    for (std::size_t begin = 0; error == 0 && begin < text.size();) {
        const ssize_t written = ::write(file, text.data() + begin, text.size() - begin);
        if (written >= 0)
            begin += static_cast<std::size_t>(written);
        else if (errno != EINTR)
            error = errno;
    }
    if (error != 0 && file >= 0) static_cast<void>(::ftruncate(file, size)); // no half line
    if (file >= 0 && ::close(file) != 0 && error == 0) error = errno;
    return error == 0 ? "" : "cannot write " + path + ": " + std::strerror(error);
}

} // namespace

std::string csv_of(const MeasuredTable& table, const std::string& scene_name) {
    std::string text = fmt::format("# {}: {}\n", plain_field(scene_name), table.name);
    for (const std::string& remark : table.remarks) text += fmt::format("# {}\n", remark);
    for (std::size_t k = 0; k < table.columns.size(); ++k)
        text += (k == 0 ? "" : ",") + table.columns[k];
    return text + '\n' + lines_of(table.rows);
}

void write_tables(const Scene& scene, const std::vector<MeasuredTable>& tables,
                  const Communicator& ranks) {
    std::string failure;
    if (ranks.is_root()) {
        for (const MeasuredTable& table : tables) {
            if (failure.empty() && table.name != "thermo")
                failure = write_whole_file(path_of(scene, table), csv_of(table, scene.name));
        }
    }
    agree(ranks, failure.empty(), failure, ExitCode::output_failure);
}

void ThermoFile::add_rows_of(const Sampler& sampler) {
    const std::optional<MeasuredTable> rows = sampler.thermo_from(n_written_);
    if (!rows) return;
    std::string failure;
    if (ranks_.is_root()) {
        const std::string path = path_of(scene_, *rows);
        failure = n_written_ == 0 ? write_whole_file(path, csv_of(*rows, scene_.name))
                                  : append_to(path, lines_of(rows->rows));
    }
    agree(ranks_, failure.empty(), failure, ExitCode::output_failure);
    n_written_ += rows->rows.size();
}

} // namespace carrom
