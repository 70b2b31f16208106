// SPDX-License-Identifier: BSD-3-Clause
#include "scene/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random_numbers.hpp"

namespace carrom {

namespace {

/// Widths in spacings: the sites of a lattice span `x_spans` times dx and `y_spans` times dy.
struct Shape {
    Lattice lattice;
    double x_spans = 0, y_spans = 0;
};

Shape shape_of(std::uint64_t n_discs, std::uint64_t rows, bool is_staggered,
               bool odd_rows_are_shorter) {
    Shape shape;
    Lattice& lattice = shape.lattice;
    lattice.n_discs = n_discs;
    lattice.rows = rows;
    const std::uint64_t n_removed = odd_rows_are_shorter ? rows / 2 : 0;
    lattice.columns = (n_discs + n_removed + rows - 1) / rows;
    lattice.is_staggered = is_staggered;
    lattice.odd_rows_are_shorter = odd_rows_are_shorter;
    shape.x_spans = static_cast<double>(lattice.columns - 1) +
                    (is_staggered && !odd_rows_are_shorter && rows > 1 ? 0.5 : 0.0);
    shape.y_spans = static_cast<double>(rows - 1);
    return shape;
}

/// Distance of nearest sites, as a share of the width of the lattice.
double nearest_share(const Shape& shape) {
    const double infinity = std::numeric_limits<double>::infinity();
    const double dx = shape.x_spans > 0 ? 1 / shape.x_spans : infinity;
    const double dy = shape.y_spans > 0 ? 1 / shape.y_spans : infinity;
    const bool has_neighbour_in_row = shape.lattice.columns > 1;
    const double in_row = has_neighbour_in_row ? dx : infinity;
    if (!shape.lattice.is_staggered || shape.y_spans == 0) return std::min(in_row, dy);
    const double half = shape.x_spans > 0 ? dx / 2 : 0;
    const double next_row = std::sqrt(half * half + dy * dy);
    const double second_row = shape.lattice.rows > 2 ? 2 * dy : infinity;
    return std::min({in_row, next_row, second_row});
}

/// Spreads the sites over the box. With w = L - 2r - 2s the width of the lattice and q w the
/// nearest distance, the free radius s solves q w - 2r = 2s.
void place(Shape& shape, double box_size, double radius) {
    Lattice& lattice = shape.lattice;
    const double q = nearest_share(shape);
    const double span = box_size - 2 * radius;
    lattice.free_radius = std::isfinite(q) ? (q * span - 2 * radius) / (2 * (1 + q)) : span / 2;
    const double low = radius + std::max(lattice.free_radius, 0.0);
    const double width = box_size - 2 * low;
    lattice.dx = shape.x_spans > 0 ? width / shape.x_spans : 0;
    lattice.dy = shape.y_spans > 0 ? width / shape.y_spans : 0;
    lattice.x0 = shape.x_spans > 0 ? low : box_size / 2;
    lattice.y0 = shape.y_spans > 0 ? low : box_size / 2;
}

} // namespace

std::optional<Lattice> widest_lattice(std::uint64_t n_discs, double box_size, double radius) {
    std::optional<Lattice> widest;
    const auto side = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(n_discs)));
    const std::uint64_t most_rows = std::min(n_discs, 2 * side + 4);
    for (std::uint64_t rows = 1; rows <= most_rows; ++rows) {
        for (const int kind : {0, 1, 2}) {
            if (kind == 2 && (n_discs + rows / 2 + rows - 1) / rows < 2)
                continue; // odd rows would be empty
            Shape shape = shape_of(n_discs, rows, kind > 0, kind == 2);
            place(shape, box_size, radius);
            if (!widest || shape.lattice.free_radius > widest->free_radius) widest = shape.lattice;
        }
    }
    // Touching neighbours are fine, and a rounding error of L deeper than touching is within the
    // method's tolerance.
    if (widest->free_radius < -0x1p-52 * box_size) return std::nullopt;
    widest->free_radius = std::max(widest->free_radius - 0x1p-49 * box_size,
                                   0.0); // rounding must not close a gap
    return widest;
}

Point lattice_site(const Lattice& lattice, DiscId id) {
    __extension__ using Wide = unsigned __int128;
    // Empty sites are spread evenly: ids are stretched over the sites.
    const auto site = static_cast<std::uint64_t>(static_cast<Wide>(id) * lattice.n_sites() /
                                                 lattice.n_discs);
    std::uint64_t row = 0, column = 0;
    if (lattice.odd_rows_are_shorter) {
        const std::uint64_t two_rows = 2 * lattice.columns - 1;
        const std::uint64_t rest = site % two_rows;
        row = 2 * (site / two_rows) + (rest >= lattice.columns);
        column = rest >= lattice.columns ? rest - lattice.columns : rest;
    } else {
        row = site / lattice.columns;
        column = site % lattice.columns;
    }
    const double shift = lattice.is_staggered && row % 2 == 1 ? 0.5 : 0.0;
    return {lattice.x0 + (static_cast<double>(column) + shift) * lattice.dx,
            lattice.y0 + static_cast<double>(row) * lattice.dy};
}

Point shaken_site(const Lattice& lattice, DiscId id, std::uint64_t seed) {
    DiscRandom random(seed, Purpose::shake, id);
    Point site = lattice_site(lattice, id);
    for (;;) {
        const double x = 2 * random.uniform() - 1;
        const double y = 2 * random.uniform() - 1;
        if (x * x + y * y > 1) continue;
        site.x += x * lattice.free_radius;
        site.y += y * lattice.free_radius;
        return site;
    }
}

} // namespace carrom
