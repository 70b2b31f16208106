// SPDX-License-Identifier: BSD-3-Clause
// Rejects most possible partners of a flight in a block run, many at a time. From given ranges of
// slots, the filter picks the flights that might touch a given flight before the window ends. It
// may keep pairs that never touch, but it never loses a pair that does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cell_list/cell_grid.hpp"

namespace carrom {

/// A disc in flight: its position at the time `now` in cells, and its velocity in cells per window.
/// Times go from 0 to 1 in a window.
struct Flight {
    float x = 0, y = 0, vx = 0, vy = 0;
    float now = 0;
    std::uint32_t slot = 0;
};

/// Flights of discs of several sizes, with their radii in units of the lanes.
struct SizedLanes : FlightLanes {
    const float* radii = nullptr;
};

struct PartnerCounts {
    std::size_t p = 0, q = 0;
};

/// Cells of a block, column by column. Slots of cell (c, r) begin at starts[c * column_length + r]
/// and end where the next cell begins. `starts` has n_rows + 1 entries for each column.
struct CellTable {
    const std::uint32_t* starts = nullptr;
    std::size_t column_length = 0;
    int n_columns = 0, n_rows = 0;
    /// The partners of a disc are at most this many columns and rows away
    int n_reach_columns = 1, n_reach_rows = 1;
};

/// The rows `first` to `end` - 1 of a column of cells.
struct CellRows {
    int first = 0, end = 0;
};

/// The filters for discs of one size (FlightLanes) or of several (SizedLanes). Lanes hold positions
/// extrapolated to the window's start, and must be readable up to `filter_padding` entries beyond
/// the last slot.
///
/// Discs count as touching if their centres are closer than a certain distance. For discs of one
/// size, `touching` is the square of this distance. For several sizes the distance is the sum of
/// the two radii and a margin, and `touching` is the flight's radius plus the margin; in `column`
/// it is the margin alone.
template <class SomeLanes> struct FlightFilters {
    /// Writes the slots of `runs` whose flights might touch `flight`, except the slot of `flight`
    /// itself, and returns their number. `out` must have room for all slots of the runs and
    /// `filter_padding` more.
    std::size_t (*one)(const SomeLanes& lanes, std::span<const SlotRange> runs,
                       const Flight& flight, float touching, std::uint32_t* out);

    /// Does the same as `one` for two flights with the same `now` in one pass, and writes a list
    /// for each. Neither list contains the slots of these two flights.
    PartnerCounts (*two)(const SomeLanes& lanes, std::span<const SlotRange> runs, const Flight& p,
                         const Flight& q, float p_touching, float q_touching, std::uint32_t* p_out,
                         std::uint32_t* q_out);

    /// Finds each pair of a disc in `rows` of a column and a later disc that might touch in the
    /// window. The later disc follows in the same column or is in a column to the right, and is
    /// within the table's reach. Writes the later discs to the front of `partners`, whose size
    /// never shrinks. Appends to `ends`, for each disc of the rows, the end of its partners in
    /// that list.
    void (*column)(const SomeLanes& lanes, const CellTable& cells, int column, CellRows rows,
                   float touching, std::vector<std::uint32_t>& partners,
                   std::vector<std::uint32_t>& ends);
};

/// The filters for the instruction set of this processor.
template <class SomeLanes> const FlightFilters<SomeLanes>& flight_filters();
template <> const FlightFilters<FlightLanes>& flight_filters();
template <> const FlightFilters<SizedLanes>& flight_filters();

} // namespace carrom
