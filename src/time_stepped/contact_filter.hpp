// SPDX-License-Identifier: BSD-3-Clause
// First rejection of pairs, many lanes at a time: which flights of a run of slots might touch a
// given disc's in this window. It may keep pairs that never touch; it never loses one that does.
// The widest instruction set that the machine has is chosen when the program runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cell_list/cell_grid.hpp"

namespace carrom {

/// Writes to the front of `pairs`, which grows as needed, all pairs (first, second) that might
/// touch. `first` is an own disc in `column`. `second` is an own one after it in the half stencil,
/// later in its own column or in one to the right, or a halo disc around it. Returns how many.
std::size_t filter_column(const CellGrid& grid, int column, float touching_squared,
                          std::vector<DiscPair>& pairs);

/// Writes to `pairs`, behind the first `n_pairs`, the disc with each that it might touch between
/// the fraction `from` of the window and its end. Pairs of halo discs are left out. Returns how
/// many pairs there are now. Only cells within `half_reach` of that part of its path are looked at:
/// so far from where two discs touch can the other one's cell be.
std::size_t filter_around(const CellGrid& grid, LocalIndex index, float from, float half_reach,
                          float touching_squared, std::vector<DiscPair>& pairs,
                          std::size_t n_pairs);

/// The same for disc k of those that the grid has set apart, for all of the window; `first` is k.
/// With filter_apart_pairs `second` is another place among those set apart, after k.
std::size_t filter_apart(const CellGrid& grid, std::uint32_t k, float half_reach,
                         float touching_squared, std::vector<DiscPair>& pairs, std::size_t n_pairs);
std::size_t filter_apart_pairs(const CellGrid& grid, std::uint32_t k, float touching_squared,
                               std::vector<DiscPair>& pairs, std::size_t n_pairs);

/// The instruction set in use, as in "AVX3".
const char* filter_target();

} // namespace carrom
