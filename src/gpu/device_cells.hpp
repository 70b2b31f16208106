// SPDX-License-Identifier: BSD-3-Clause
// The cells of a device's discs: a box cut into rectangles, row after row. The discs of a cell are
// stored together in any order, because no result depends on this order.
//
// Along a periodic axis the row of cells repeats. So a disc beyond a side is found in a cell of
// the box, as an image displaced by whole boxes; no disc is stored twice.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <carrom/box.hpp>

#include "core/device.hpp"
#include "core/image.hpp"

namespace carrom {

/// One axis of the box, cut into `n` cells. Partners of a disc are at most `around` cells away.
struct CellsAlong {
    double cells_per_length = 0;
    int n = 1, around = 1;
    bool is_periodic = false;

    CellsAlong() = default;
    /// Cells are at least `least_width` long. If the box is periodic and shorter than `reach`, a
    /// disc has partners in several images of the box.
    CellsAlong(double length, double least_width, double reach, bool repeats)
        : n(static_cast<int>(std::clamp(std::floor(length / least_width), 1.0, 30000.0))),
          is_periodic(repeats) {
        cells_per_length = n / length;
        around = static_cast<int>(std::clamp(std::ceil(reach * cells_per_length), 1.0, 15000.0));
    }

    CARROM_DEVICE int of(double place) const {
        return static_cast<int>(
            std::clamp(std::floor(place * cells_per_length), 0.0, static_cast<double>(n - 1)));
    }
    CARROM_DEVICE int first(int cell) const {
        return is_periodic ? cell - around : std::max(cell - around, 0);
    }
    CARROM_DEVICE int last(int cell) const {
        return is_periodic ? cell + around : std::min(cell + around, n - 1);
    }
    /// The periodic copy of the box that contains this cell of the repeated row: 0 is the box
    /// itself, 1 the next copy towards larger coordinates, -1 the next one in the other direction.
    CARROM_DEVICE int box_of(int cell) const {
        if (!is_periodic || (cell >= 0 && cell < n)) return 0;
        return cell >= 0 ? cell / n : -((n - 1 - cell) / n);
    }
};

/// The cells of both axes. `begins[c]` is the first slot of cell c; the last entry is the end.
struct DeviceCells {
    CellsAlong x, y;
    std::uint32_t* begins = nullptr;

    CARROM_DEVICE std::uint32_t n_cells() const {
        return static_cast<std::uint32_t>(x.n) * static_cast<std::uint32_t>(y.n);
    }
    CARROM_DEVICE std::uint32_t of(double at_x, double at_y) const {
        return static_cast<std::uint32_t>(y.of(at_y) * x.n + x.of(at_x));
    }
    /// Calls visit(slot, image) for each disc in `cell` and in the cells around it. The disc is
    /// displaced by `image` in addition to the image in its state.
    template <class Visit>
    CARROM_DEVICE void for_each_near(std::uint32_t cell, const Visit& visit) const {
        const int column = static_cast<int>(cell) % x.n, row = static_cast<int>(cell) / x.n;
        const int x_end = x.last(column) + 1, y_end = y.last(row) + 1;
        for (int at_y = y.first(row); at_y < y_end; ++at_y) {
            const int up = y.box_of(at_y), first_of_row = (at_y - up * y.n) * x.n;
            for (int at_x = x.first(column); at_x < x_end;) {
                const int right = x.box_of(at_x), first = at_x - right * x.n,
                          n = std::min(x_end - at_x, x.n - first); // up to the end of this box
                const std::uint32_t end = begins[first_of_row + first + n];
                for (std::uint32_t slot = begins[first_of_row + first]; slot < end; ++slot)
                    visit(slot, Image{right, up});
                at_x += n;
            }
        }
    }
};

/// Cells for n discs whose partners are within `reach`. Cells are at least `reach` wide and hold at
/// least 0.4 discs on average; they are this small to save tests of pairs.
inline DeviceCells cells_for(const Box& box, const Periods& periods, double reach,
                             std::uint64_t n_discs) {
    constexpr double discs_in_cell = 0.4;
    const double even = std::sqrt(discs_in_cell * box.area() /
                                  std::max(1.0, static_cast<double>(n_discs))),
                 least = std::max(reach, even);
    DeviceCells cells;
    cells.x = CellsAlong(box.x, least, reach, periods.x != 0);
    cells.y = CellsAlong(box.y, least, reach, periods.y != 0);
    return cells;
}

} // namespace carrom
