// SPDX-License-Identifier: BSD-3-Clause
// Rejects most pairs, many lanes at a time: it finds the flights in a run of slots that might touch
// a given flight in this window. It may keep pairs that never touch, but loses none that do. The
// widest instruction set of the machine is chosen when the program runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cell_list/cell_grid.hpp"

namespace carrom {

/// Writes pairs (first, second) that might touch to the front of `pairs`, which grows as needed.
/// `first` is an own disc in `column`. `second` is a halo disc around it, or an own disc after it
/// in the half stencil: later in its column, or in one to the right. Returns the number of pairs.
std::size_t filter_column(const CellGrid& grid, int column, float touching_squared,
                          std::vector<DiscPair>& pairs);

/// Appends to the first `n_pairs` entries of `pairs` the pairs of the disc with each disc that it
/// might touch between the fraction `from` of the window and its end. Omits pairs of two halo
/// discs. Returns the new number of pairs. Only cells within `half_reach` of that part of the path
/// are searched, because no partner's cell is further away from the position of a contact.
std::size_t filter_around(const CellGrid& grid, LocalIndex index, float from, float half_reach,
                          float touching_squared, std::vector<DiscPair>& pairs,
                          std::size_t n_pairs);

/// Like filter_around for flight k of `lanes`. Pairs of two halo discs are included; `first` is k.
std::size_t filter_along(const CellGrid& grid, const FlightLanes& lanes, std::uint32_t k,
                         float from, float half_reach, float touching_squared,
                         std::vector<DiscPair>& pairs, std::size_t n_pairs);
/// Like filter_around, for flight k of `lanes` and the flights `run` of `others`, over the whole
/// window; `first` is k, and `second` is an index in `others`.
std::size_t filter_lanes(const FlightLanes& lanes, std::uint32_t k, const FlightLanes& others,
                         SlotRange run, float touching_squared, std::vector<DiscPair>& pairs,
                         std::size_t n_pairs);

/// The instruction set in use, such as "AVX3".
const char* filter_target();

} // namespace carrom
