// SPDX-License-Identifier: BSD-3-Clause
#include "io/table_file.hpp"

#include <fcntl.h>

#include "io/checked_dataset.hpp"
#include "io/child_process.hpp"
#include "io/files.hpp"
#include "io/hdf5.hpp"

namespace carrom {

namespace {

constexpr const char* remarks_name = "remarks";

void write_table(hid_t file, const MeasuredTable& table) {
    const h5::Group group = h5::create_group(file, table.name);
    h5::write_attribute(group.id(), remarks_name, table.remarks);
    std::vector<double> numbers(table.rows.size());
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
        for (std::size_t row = 0; row < numbers.size(); ++row)
            numbers[row] = table.rows[row][column];
        h5::write_column(group.id(), table.columns[column], numbers);
    }
}

void check_tables(hid_t file) {
    H5G_info_t all{};
    h5::checked(H5Gget_info(file, &all), "cannot be listed");
    if (all.nlinks == 0) throw FileError("has no table");
    for (hsize_t k = 0; k < all.nlinks; ++k)
        if (h5::checked(H5Aexists_by_name(file, h5::name_of_link(file, k).c_str(), remarks_name,
                                          H5P_DEFAULT),
                        "cannot be read") == 0)
            throw FileError("has what is no table");
}

} // namespace

bool is_table_file(const std::string& path) {
    try {
        inspect_in_child_first(
            [&path] { check_tables(h5::open_file(path, h5::Access::read).id()); });
        return true;
    } catch (const FileError&) {
        return false;
    }
}

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
