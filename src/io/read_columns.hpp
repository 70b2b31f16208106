// SPDX-License-Identifier: BSD-3-Clause
// Whole columns of numbers, and how far they go. Each throws FileError.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/hdf5.hpp"

namespace carrom {

hsize_t length_of(hid_t file, const std::string& path);

std::vector<std::int64_t> read_numbers(hid_t file, const std::string& path);

/// How many of the ascending numbers are <= `last`; reads a few of them.
hsize_t count_up_to(hid_t file, const std::string& path, std::int64_t last);

} // namespace carrom
