// SPDX-License-Identifier: BSD-3-Clause
// What the two halves of CellGrid share: where discs are, and what is written down of it.
#pragma once

#include <cstdint>

#include "cell_list/cell_grid.hpp"

namespace carrom {

/// First index of the `part`-th of `n_parts` equal shares of n.
inline std::size_t share(std::size_t n, std::size_t part, std::size_t n_parts) {
    return n * part / n_parts;
}

/// Where discs are without periodic sides.
struct StoredPlaces {
    static double x_of(const Disc& disc, double time) { return disc.x_at(time); }
    static double y_of(const Disc& disc, double time) { return disc.y_at(time); }
};

template <class Places>
std::uint32_t CellGrid::column_at(const Places& places, const Disc& disc) const {
    return static_cast<std::uint32_t>(frame_.column_of(places.x_of(disc, anchor_)));
}

template <class Places>
std::uint32_t CellGrid::row_at(const Places& places, const Disc& disc) const {
    return static_cast<std::uint32_t>(frame_.row_of(places.y_of(disc, anchor_)));
}

template <class Places>
std::uint32_t CellGrid::cell_at(const Places& places, const Disc& disc) const {
    return column_at(places, disc) * rows() + row_at(places, disc);
}

template <class Places>
void CellGrid::place(const Places& places, float* flight, std::size_t length,
                     const Disc& disc) const {
    const double cells = frame_.cells_per_length();
    flight[0] = static_cast<float>((places.x_of(disc, time_) - frame_.x_low) * cells);
    flight[length] = static_cast<float>((places.y_of(disc, time_) - frame_.y_low) * cells);
    flight[2 * length] = static_cast<float>(disc.vx * duration_ * cells);
    flight[3 * length] = static_cast<float>(disc.vy * duration_ * cells);
}

} // namespace carrom
