// SPDX-License-Identifier: BSD-3-Clause
#include "io/table_file.hpp"

#include <fcntl.h>

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
    try {
        replace_file(path, [&](const std::string& beside) {
            h5::create_file(beside, [&](hid_t file) {
                for (const MeasuredTable& table : tables) write_table(file, table);
            });
            Descriptor(beside, O_WRONLY).sync();
        });
    } catch (const FileError& failure) {
        return path + ": " + failure.what();
    }
    return {};
}

} // namespace carrom
