// SPDX-License-Identifier: BSD-3-Clause
// First rejection of pairs, many lanes at a time: which flights of a run of slots might touch a given disc's in this
// window. It may keep pairs that never touch; it never loses one that does. The widest instruction set that the
// machine has is chosen when the program runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "carrom/collision/cell_grid.hpp"

namespace carrom {

/// Appends to `pairs` all pairs (first, second) that might touch, `first` in `column` and `second` after it in the half
/// stencil: later in its own column or in a column to the right.
void filter_column(const CellGrid& grid, int column, float touching_squared, std::vector<SlotPair>& pairs);

/// Appends to `partners` the slots anywhere in reach of the disc that might touch it, itself excluded.
void filter_around(const CellGrid& grid, LocalIndex index, float touching_squared, std::vector<std::uint32_t>& partners);

/// The instruction set in use, as in "AVX3".
const char* filter_target();

} // namespace carrom
