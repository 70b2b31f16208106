// SPDX-License-Identifier: BSD-3-Clause
// The lattice of N discs between walls that has the widest gaps, and random shifts of its discs
// that never make discs overlap.
//
// Candidates are a square lattice and two hexagonal ones (rows of n and n, rows of n and n-1
// sites), stretched to fill the box, with rows along either axis and up to twice as many rows as a
// lattice of equal spacings has. The lattice with the widest gaps is chosen. Its sites leave a gap
// s to the walls and 2 s between discs, so each disc may be moved by up to s in any direction
// without an overlap. Sites in excess of N stay empty, spread evenly. Finding the lattice costs
// O(sqrt N) in a square box, and computing the position of a site costs O(1).
#pragma once

#include <cstdint>
#include <optional>

#include "core/axis.hpp"
#include "core/disc_state.hpp"

namespace carrom {

struct Lattice {
    std::uint64_t n_discs = 0;
    std::uint64_t rows = 0, columns = 0; ///< columns: number of sites in an even row
    bool is_staggered = false;           ///< odd rows are shifted by half a spacing
    bool odd_rows_are_shorter = false;   ///< odd rows have one site less
    Axis axis = Axis::x;                 ///< rows run along this axis, which is called x below
    double x0 = 0, y0 = 0;               ///< position of the first site
    double dx = 0, dy = 0;               ///< spacing in a row, and between rows
    double free_radius = 0;              ///< s: the distance by which each disc may be moved

    std::uint64_t n_sites() const { return rows * columns - (odd_rows_are_shorter ? rows / 2 : 0); }
};

/// The lattice with the widest gaps; nothing if discs overlap even on it. Needs n_discs > 0 and
/// edges >= 2 radius > 0.
std::optional<Lattice> widest_lattice(std::uint64_t n_discs, const Box& box, double radius);

struct Point {
    double x = 0, y = 0;

    friend bool operator==(const Point&, const Point&) = default;
};

/// The site of disc `id`.
Point lattice_site(const Lattice& lattice, DiscId id);

/// The site, shifted to a random position within `free_radius`. Rows lie along `axis`.
Point shaken(Point site, double free_radius, std::uint64_t seed, DiscId id, Axis axis = Axis::x);

/// The site of disc `id`, shifted to a random position within the free radius.
Point shaken_site(const Lattice& lattice, DiscId id, std::uint64_t seed);

/// A number coprime to n and near the golden section of n. Steps of this size through the sites mix
/// species, whose ids are consecutive.
std::uint64_t mixing_stride(std::uint64_t n);

} // namespace carrom
