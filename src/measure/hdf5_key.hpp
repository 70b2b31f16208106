// SPDX-License-Identifier: BSD-3-Clause
// The setting that writes tables to an HDF5 file, too. Quantities with large tables share it.
#pragma once

#include "scene/quantity.hpp"

namespace carrom {

inline constexpr QuantitySetting hdf5_setting{"hdf5", 0};

inline Key hdf5_key() {
    return hdf5_setting.integer("1", "1: all tables are in the file tables.h5 as well.")
        .within({0, 1});
}

} // namespace carrom
