// SPDX-License-Identifier: BSD-3-Clause
#include "lattices/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/random_numbers.hpp"

namespace carrom {

namespace {

/// A lattice and its size in spacings: its sites span `x_spans` times dx and `y_spans` times dy.
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

/// The distance between nearest sites relative to the lattice's width, in a square box.
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

/// Half the gap between nearest neighbours in a square box. With the width w = L - 2r - 2s of the
/// lattice and its nearest distance q w, the free radius s solves q w - 2r = 2s.
double free_radius_in_square(const Shape& shape, double side, double radius) {
    const double q = nearest_share(shape);
    const double span = side - 2 * radius;
    return std::isfinite(q) ? (q * span - 2 * radius) / (2 * (1 + q)) : span / 2;
}

/// Half the gap in a rectangular box, with the edges `length` along rows and `height` across them.
/// Sites span each edge minus d, where d = 2r + 2s is the distance between nearest neighbours. So
/// each kind of neighbour gives an equation for d, and the smallest solution counts. Staggered rows
/// give A d^2 - 2 B d + C = 0.
double free_radius_in(const Shape& shape, double length, double height, double radius) {
    if (length == height) return free_radius_in_square(shape, length, radius);
    double nearest = std::numeric_limits<double>::infinity();
    if (shape.lattice.columns > 1) nearest = length / (1 + shape.x_spans);
    if (shape.y_spans > 0 && !shape.lattice.is_staggered)
        nearest = std::min(nearest, height / (1 + shape.y_spans));
    if (shape.y_spans > 0 && shape.lattice.is_staggered) {
        const double a = shape.x_spans > 0 ? 1 / (2 * shape.x_spans) : 0, b = 1 / shape.y_spans;
        const double u = a * length, v = b * height;
        const double coefficient = a * a + b * b - 1, half = a * u + b * v, rest = u * u + v * v;
        const double root = std::sqrt(std::max(half * half - coefficient * rest, 0.0));
        nearest = std::min(nearest, rest / (half + root));
        if (shape.lattice.rows > 2) nearest = std::min(nearest, 2 * height / (2 + shape.y_spans));
    }
    // In a narrow tube the walls are closer than other discs
    return std::min({nearest, length, height}) / 2 - radius;
}

/// Stretches the lattice so that it fills the box, and sets its free radius.
void place(Shape& shape, const Box& box, double radius) {
    Lattice& lattice = shape.lattice;
    const auto [length, height] = turned(lattice.axis, box.x, box.y);
    lattice.free_radius = free_radius_in(shape, length, height, radius);
    const double low = radius + std::max(lattice.free_radius, 0.0);
    lattice.dx = shape.x_spans > 0 ? (length - 2 * low) / shape.x_spans : 0;
    lattice.dy = shape.y_spans > 0 ? (height - 2 * low) / shape.y_spans : 0;
    lattice.x0 = shape.x_spans > 0 ? low : length / 2;
    lattice.y0 = shape.y_spans > 0 ? low : height / 2;
}

/// Tries lattices with rows along `axis`, and keeps the one with the widest gaps.
void try_rows_along(Axis axis, std::uint64_t n_discs, const Box& box, double radius,
                    std::optional<Lattice>& widest) {
    const auto [length, height] = turned(axis, box.x, box.y);
    const double n = static_cast<double>(n_discs);
    const auto side = static_cast<std::uint64_t>(std::min(n, std::sqrt(n * (height / length))));
    const std::uint64_t most_rows = std::min(n_discs, 2 * side + 4);
    for (std::uint64_t rows = 1; rows <= most_rows; ++rows) {
        for (const int kind : {0, 1, 2}) {
            if (kind == 2 && (n_discs + rows / 2 + rows - 1) / rows < 2)
                continue; // odd rows would be empty
            Shape shape = shape_of(n_discs, rows, kind > 0, kind == 2);
            shape.lattice.axis = axis;
            place(shape, box, radius);
            if (!widest || shape.lattice.free_radius > widest->free_radius) widest = shape.lattice;
        }
    }
}

} // namespace

std::optional<Lattice> widest_lattice(std::uint64_t n_discs, const Box& box, double radius) {
    std::optional<Lattice> widest;
    try_rows_along(longer_axis(box), n_discs, box, radius, widest);
    if (!box.is_square())
        try_rows_along(other_axis(longer_axis(box)), n_discs, box, radius, widest);
    // Neighbours may touch. An overlap as small as the rounding error of an edge of the box is
    // within the tolerance of the method.
    if (widest->free_radius < -0x1p-52 * box.longest()) return std::nullopt;
    widest->free_radius = std::max(widest->free_radius - 0x1p-49 * box.longest(),
                                   0.0); // rounding must not make the gap negative
    return widest;
}

Point lattice_site(const Lattice& lattice, DiscId id) {
    __extension__ using Wide = unsigned __int128;
    // Empty sites are spread evenly, by scaling ids to sites.
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
    const auto [x, y] = turned(lattice.axis,
                               lattice.x0 + (static_cast<double>(column) + shift) * lattice.dx,
                               lattice.y0 + static_cast<double>(row) * lattice.dy);
    return {x, y};
}

Point shaken(Point site, double free_radius, std::uint64_t seed, DiscId id, Axis axis) {
    DiscRandom random(seed, Purpose::shake, id);
    for (;;) {
        const double u = 2 * random.uniform() - 1;
        const double v = 2 * random.uniform() - 1;
        if (u * u + v * v > 1) continue;
        const auto [x, y] = turned(axis, u, v);
        site.x += x * free_radius;
        site.y += y * free_radius;
        return site;
    }
}

Point shaken_site(const Lattice& lattice, DiscId id, std::uint64_t seed) {
    return shaken(lattice_site(lattice, id), lattice.free_radius, seed, id, lattice.axis);
}

std::uint64_t mixing_stride(std::uint64_t n) {
    auto stride = static_cast<std::uint64_t>(0.6180339887498949 * static_cast<double>(n)) | 1;
    while (std::gcd(stride, n) != 1) stride += 2;
    return stride;
}

} // namespace carrom
