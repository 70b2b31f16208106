// SPDX-License-Identifier: BSD-3-Clause
// The triangular lattice that a periodic box repeats without a fault: n columns and an even number
// m of rows, each shifted by half a spacing against the one before. The spacing a divides one edge,
// n a, and m rows at a sqrt(3) / 2 the other one. So the edges' ratio is that of two whole numbers
// times sqrt(3) / 2, and few numbers of discs go with a box.
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
    Axis axis = Axis::x;            ///< rows lie along it
    double spacing = 0, height = 0; ///< in a row, and between rows

    /// The distance of nearest sites.
    double nearest() const;
    Point site(DiscId id) const;
};

/// The edges of a scene have some digits only, so their ratio may be off by this much.
/// The lattice is stretched to fill the box.
inline constexpr double largest_stretch = 1e-4;

/// The lattice for n_discs discs, with rows along x or y; nothing if none fits.
std::optional<TriangularLattice> triangular_lattice(std::uint64_t n_discs, const Box& box);

/// The keys of a lattice that fits, with about as many discs in a box of about the
/// same shape: "discs.count = 120, box.size = [10, 10.392305] (10 x 12)".
std::string nearest_triangular(std::uint64_t n_discs, const Box& box);

} // namespace carrom
