// SPDX-License-Identifier: BSD-3-Clause
// The parts of H5MD 1.1 (de Buyl, Colberg, Hoefling 2014) that checkpoints and recordings share:
// discs in a box whose third edge is 1, because H5MD's readers expect three dimensions.
#pragma once

#include <array>
#include <string>

#include "io/hdf5.hpp"
#include "io/recorded_system.hpp"

namespace carrom::h5md {

inline constexpr const char *discs_path = "/particles/discs/",
                            *collisions_path = "/carrom/collisions/",   ///< a path outside H5MD
                                *gaps_path = "/carrom/collisions/gaps"; ///< first and last
                                                                        ///< step of each gap
inline constexpr const char *step_path = "/particles/discs/box/edges/step",
                            *time_path = "/particles/discs/box/edges/time",
                            *edges_path = "/particles/discs/box/edges/value";

/// The table of species; absent if all discs are equal.
inline constexpr const char* shown_species_path = "/parameters/species";

/// Writes /h5md, /parameters, and /particles/discs with the box; the caller adds the box's `edges`.
void write_system(hid_t file, const RecordedSystem& system);

/// Writes radius, mass and species of each disc. If all discs are equal, the values are fill
/// values, which take no space.
void write_bodies(hid_t file, const RecordedSystem& system);

std::array<double, 3> edges_of(const Box& box);

/// The unit of length^`lengths` times time^`times`, in the notation of H5MD's module `units`. Empty
/// if the scene does not name these units.
std::string unit_of(const RecordedSystem& system, int lengths, int times);
void write_unit(hid_t dataset, const std::string& unit);

} // namespace carrom::h5md
