// SPDX-License-Identifier: BSD-3-Clause
#include "io/table_file.hpp"

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "io/files.hpp"
#include "io/hdf5.hpp"

namespace carrom {

namespace {

void write_table(hid_t file, const MeasuredTable& table) {
    const h5::Group group = h5::create_group(file, table.name);
    h5::write_attribute(group.id(), "remarks", table.remarks);
    std::vector<double> numbers(table.rows.size());
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
        for (std::size_t row = 0; row < numbers.size(); ++row)
            numbers[row] = table.rows[row][column];
        h5::write_column(group.id(), table.columns[column], numbers);
    }
}

} // namespace

std::string write_table_file(const std::string& path, std::span<const MeasuredTable> tables) {
    const std::string partial = path + ".partial";
    std::error_code error;
    std::filesystem::remove(partial, error); // of a run that was killed
    try {
        h5::create_file(partial, [&](hid_t file) {
            for (const MeasuredTable& table : tables) write_table(file, table);
        });
    } catch (const FileError& failure) {
        std::filesystem::remove(partial, error);
        return path + ": " + failure.what();
    }
    std::filesystem::rename(partial, path, error);
    return error ? "cannot write " + path + ": " + error.message() : "";
}

} // namespace carrom
