// SPDX-License-Identifier: BSD-3-Clause
// A triangular lattice that fits a periodic box without a defect. It has n columns and an even
// number m of rows, each shifted by half a spacing relative to the previous row. With the spacing
// a, one edge is n a, and the other is m a sqrt(3) / 2. So the ratio of the edges is a ratio of two
// whole numbers times sqrt(3) / 2, and only a few numbers of discs fit a given box.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/axis.hpp"
#include "core/disc_state.hpp"
#include "lattices/lattice.hpp"

namespace carrom {

struct TriangularLattice {
    std::uint64_t columns = 0, rows = 0;
    Axis axis = Axis::x;            ///< rows run along this axis
    double spacing = 0, height = 0; ///< spacing in a row, and distance between rows

    /// The distance between nearest sites.
    double nearest() const;
    Point site(DiscId id) const;
};

/// Largest relative error of the ratio of the edges, because scenes give edges with few digits. The
/// lattice is stretched to fill the box.
inline constexpr double largest_stretch = 1e-4;

/// The lattice for n_discs discs, with rows along x or y; nothing if none fits.
std::optional<TriangularLattice> triangular_lattice(std::uint64_t n_discs, const Box& box);

/// The scene keys of the most similar lattice that fits, with about n_discs discs in a box of about
/// the same shape, such as "discs.count = 120, box.size = [10, 10.392305] (10 x 12)".
std::string nearest_triangular(std::uint64_t n_discs, const Box& box);

} // namespace carrom
