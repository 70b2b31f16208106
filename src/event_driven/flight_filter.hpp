// SPDX-License-Identifier: BSD-3-Clause
// First rejection of partners in a block run, many lanes at a time. It finds which flights in some
// runs of slots might touch a given one before the window ends. It may keep pairs that never touch;
// it never loses one that does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cell_list/cell_grid.hpp"

namespace carrom {

/// A disc in flight: position in cells at the time `now`, cells per window. Times run from 0 to 1
/// in a window.
struct Flight {
    float x = 0, y = 0, vx = 0, vy = 0;
    float now = 0;
    std::uint32_t slot = 0;
};

/// Writes the slots of `runs`, other than the flight's own, that might come within the square root
/// of `touching_squared` of `flight`; returns how many. Lanes hold positions extrapolated to the
/// window's start. `out` has room for all slots of the runs and `filter_padding` more; lanes can be
/// read as far beyond the last slot.
std::size_t filter_flights(const FlightLanes& lanes, std::span<const SlotRange> runs,
                           const Flight& flight, float touching_squared, std::uint32_t* out);

struct PartnerCounts {
    std::size_t p = 0, q = 0;
};

/// The same for two flights with the same `now` at once, into a list each: all slots but those of
/// the two.
PartnerCounts filter_two_flights(const FlightLanes& lanes, std::span<const SlotRange> runs,
                                 const Flight& p, const Flight& q, float touching_squared,
                                 std::uint32_t* p_out, std::uint32_t* q_out);

/// Cells of a block, column by column. Slots of cell (c, r) begin at starts[c * column_length + r]
/// and end where the next cell's begin. There is one entry more to a column than rows.
struct CellTable {
    const std::uint32_t* starts = nullptr;
    std::size_t column_length = 0;
    int n_columns = 0, n_rows = 0;
    int n_reach_columns = 1, n_reach_rows = 1; ///< in which a disc's partners can be
};

/// Rows first .. end - 1 of a column of cells.
struct CellRows {
    int first = 0, end = 0;
};

/// Finds every pair that might touch in the window, of a disc in `rows` of a column and one that
/// comes after it. That one is later in its own column, or in a column to the right, within the
/// table's reach. Puts the second ones into `partners`, which only grows. For each disc of the rows
/// it appends to `ends` where its partners end there.
void filter_column(const FlightLanes& lanes, const CellTable& cells, int column, CellRows rows,
                   float touching_squared, std::vector<std::uint32_t>& partners,
                   std::vector<std::uint32_t>& ends);

/// Flights of discs of several sizes, with their radii in cells.
struct SizedLanes : FlightLanes {
    const float* radii = nullptr;
};

/// The same of discs that might come as near as the sum of their radii and a margin. `radius` is
/// that of the flight with the margin.
std::size_t filter_sized(const SizedLanes& lanes, std::span<const SlotRange> runs,
                         const Flight& flight, float radius, std::uint32_t* out);
PartnerCounts filter_two_sized(const SizedLanes& lanes, std::span<const SlotRange> runs,
                               const Flight& p, const Flight& q, float p_radius, float q_radius,
                               std::uint32_t* p_out, std::uint32_t* q_out);
void filter_sized_column(const SizedLanes& lanes, const CellTable& cells, int column, CellRows rows,
                         float margin, std::vector<std::uint32_t>& partners,
                         std::vector<std::uint32_t>& ends);

} // namespace carrom
