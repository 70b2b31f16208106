// SPDX-License-Identifier: BSD-3-Clause
// The parts of H5MD 1.1 (de Buyl, Colberg, Hoefling 2014) that checkpoints and trajectories share:
// discs in a box whose third edge is 1, since its readers know three dimensions only.
#pragma once

#include <cstdint>
#include <string>

#include "io/hdf5.hpp"

namespace carrom::h5md {

/// /h5md: who wrote the file with what.
void write_metadata(hid_t file, const std::string& program_version);

/// `parent`/box with periodic sides along x and y, or walls; the caller adds its edges.
h5::Group create_box(hid_t parent, bool is_periodic_x, bool is_periodic_y);

} // namespace carrom::h5md
