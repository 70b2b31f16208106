// SPDX-License-Identifier: BSD-3-Clause
// Discs that are much larger than most. If cells were wide enough for these discs, each small disc
// would be compared with all others within the reach of a large disc. So cells fit most discs, and
// the few large discs are searched separately. Which discs count as large affects the run time,
// but not the bits.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "cell_list/cell_grid.hpp"
#include "dynamics/species.hpp"

namespace carrom {

/// The radius of the largest discs for which cells should be made; few discs, if any, are larger.
/// `area` is the area of the box.
double usual_radius_of(std::span<const Species> species, double radius, double area);

/// The large discs of a rank and its halo, with copies of their flights in one array.
class LargeDiscs {
public:
    /// Copies the flights of these discs from the grid.
    void assign(std::vector<LocalIndex> indices, const CellGrid& grid);
    /// Copies the disc's flight from the grid again.
    void update(LocalIndex index, const CellGrid& grid);

    std::uint32_t size() const { return static_cast<std::uint32_t>(indices_.size()); }
    LocalIndex index(std::uint32_t place) const { return indices_[place]; }
    /// The position in this list of the disc with that index.
    std::uint32_t place(LocalIndex index) const;
    FlightLanes lanes() const {
        const float* const x = lanes_.data();
        return {x, x + length_, x + 2 * length_, x + 3 * length_};
    }

private:
    void copy_flight(std::uint32_t place, const CellGrid& grid);

    std::vector<LocalIndex> indices_; ///< ascending
    std::vector<float> lanes_;        ///< all x, then all y, vx, vy, each padded to whole vectors
    std::size_t length_ = filter_padding;
};

} // namespace carrom
