// SPDX-License-Identifier: BSD-3-Clause
// What a file says of a data set, held against what this program writes before a number of it is
// read.
//
// HDF5 believes its metadata: numbers of strange types make it write beyond buffers, a claimed
// length makes it look through as many chunks, a claimed chunk takes as much memory, and a strange
// filter loads a plugin. Recordings have no seal, and a sealed file may be a forgery. Price: some
// calls that look at what is in memory already.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/hdf5.hpp"

namespace carrom::h5 {

/// The axes that a data set must have; where there is none any length will do.
using Shape = std::vector<std::optional<hsize_t>>;

/// Opens a data set to be read. Throws FileError unless it is of whole numbers or reals of 4 or 8
/// bytes or a text of fixed length, lies in this file as one piece or in chunks and under filters
/// that this program uses, has no more axes and no larger chunks than it makes, and claims no more
/// numbers than the file has room for.
Dataset open_checked(hid_t parent, const std::string& name);

/// The same for one of that shape.
Dataset open_checked(hid_t parent, const std::string& name, const Shape& shape);

} // namespace carrom::h5
