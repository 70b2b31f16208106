// SPDX-License-Identifier: BSD-3-Clause
// The parts of H5MD 1.1 (de Buyl, Colberg, Hoefling 2014) that checkpoints and recordings share:
// discs in a box whose third edge is 1, since its readers know three dimensions only.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "io/hdf5.hpp"
#include "io/recorded_system.hpp"

namespace carrom::h5md {

/// /h5md: who wrote the file with what.
void write_metadata(hid_t file, const std::string& program_version);

/// `box` in a group of particles, with its sides; the caller adds `edges`.
h5::Group create_box(hid_t parent, bool is_periodic_x, bool is_periodic_y);

/// /h5md, /parameters, and /particles/discs with the box, and radius, mass and species by disc.
/// Where discs are equal these take no room: they are fill values.
void write_system(hid_t file, const RecordedSystem& system);

std::array<double, 3> edges_of(const RecordedSystem& system);

} // namespace carrom::h5md
