// SPDX-License-Identifier: BSD-3-Clause
// What a file says of a data set, held against what this program writes before a number of it is
// read. What HDF5 itself does not survive has shown in a child process before (child_process.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/hdf5.hpp"

namespace carrom::h5 {

/// The axes that a data set must have; where there is none any length will do.
using Shape = std::vector<std::optional<hsize_t>>;

/// Opens a data set to be read. It must have that shape, if one is given. It must be of numbers or
/// of a text of fixed length. All of it must lie in this file, or in segments in the folder of this
/// file that have room for it. Throws FileError where it is not so.
Dataset open_checked(hid_t parent, const std::string& name,
                     const std::optional<Shape>& shape = std::nullopt);

/// How many of a column's ascending numbers are <= `last`.
std::uint64_t count_up_to(hid_t file, const std::string& path, std::int64_t last);

/// Throws FileError where the file cannot have as many bytes as the data set claims: memory is
/// taken by that claim.
void check_storage(const Dataset& dataset, const std::string& name);

/// All of a column. Throws FileError.
template <class Number> std::vector<Number> read_column(hid_t file, const std::string& path) {
    const Dataset dataset = open_checked(file, path, Shape{std::nullopt});
    check_storage(dataset, path);
    std::vector<Number> numbers(n_rows_of(dataset.id()));
    if (!numbers.empty())
        read_rows(dataset.id(), {0, numbers.size()}, type_of(Number{}), numbers.data());
    return numbers;
}

} // namespace carrom::h5
