// SPDX-License-Identifier: BSD-3-Clause
// Compares the structure of a file's data set with the structure that this program writes, before
// any of its numbers are read. A child process has already tested that HDF5 does not crash on the
// file (child_process.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/hdf5.hpp"

namespace carrom::h5 {

/// The lengths that a data set must have along its axes; an empty value allows any length.
using Shape = std::vector<std::optional<hsize_t>>;

/// Opens a data set for reading. It must have the shape, if one is given, and contain numbers of 4
/// or 8 bytes or texts of fixed length. Its bytes must lie in this file, or in large enough
/// segments below this file's folder. Throws FileError otherwise.
Dataset open_checked(hid_t parent, const std::string& name,
                     const std::optional<Shape>& shape = std::nullopt);

/// Returns the name of link `number` of a group, in alphabetical order. Throws FileError.
std::string name_of_link(hid_t group, hsize_t number);

/// Throws FileError unless all numbers of a file lie in it, or in plain files below its folder that
/// refer to no further files. Without this check HDF5 would open any file that is named there, wait
/// for a pipe, or return the bytes of any file as numbers.
void refuse_other_files(hid_t file, const std::string& path);

/// The number of entries of an ascending column that are <= `last`.
std::uint64_t count_up_to(hid_t file, const std::string& path, std::int64_t last);

/// Throws FileError if the data set has fewer bytes in the file than its size needs after the best
/// compression, because readers allocate memory for the whole size.
void check_storage(const Dataset& dataset, const std::string& name);

/// Returns a whole column. Throws FileError.
template <class Number> std::vector<Number> read_column(hid_t file, const std::string& path) {
    const Dataset dataset = open_checked(file, path, Shape{std::nullopt});
    check_storage(dataset, path);
    std::vector<Number> numbers(n_rows_of(dataset.id()));
    if (!numbers.empty())
        read_rows(dataset.id(), {0, numbers.size()}, type_of(Number{}), numbers.data());
    return numbers;
}

} // namespace carrom::h5
