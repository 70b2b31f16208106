// SPDX-License-Identifier: BSD-3-Clause
// Levels of cells for discs of several sizes. Each disc is in the level for its size, and the cells
// of a level are as wide as its discs need (Ogarko and Luding, Comput. Phys. Commun. 183, 931
// (2012)).
//
// With one grid for the largest discs, a small disc would test all discs within the reach of the
// largest one. But each level costs each search a few instructions, so discs of similar size share
// a level. The limits between levels do not affect the bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/species.hpp"

namespace carrom {

struct SizeLevel {
    double smallest_radius = 0, largest_radius = 0; ///< radii at the scene's start
    double n_discs = 0;
    double sum_of_radii = 0;
};

/// Returns levels from the smallest discs to the largest, or one level if there are no species.
/// `area` is the box's area. If `is_each_octave`, each octave of radii has its own level.
std::vector<SizeLevel> choose_size_levels(std::span<const Species> species, double radius,
                                          double n_discs, double area, bool is_each_octave = false);

/// The radius of equal discs that would have as many possible partners on average as these discs.
/// The length of windows is chosen for this radius.
double equivalent_radius(std::span<const SizeLevel> levels);

/// The level of a disc of this radius.
inline std::size_t level_of(double radius, std::span<const SizeLevel> levels) {
    std::size_t level = 0;
    while (level + 1 < levels.size() && radius > levels[level].largest_radius) ++level;
    return level;
}

} // namespace carrom
