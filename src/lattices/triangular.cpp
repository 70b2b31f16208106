// SPDX-License-Identifier: BSD-3-Clause
#include "lattices/triangular.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

namespace carrom {

namespace {

/// The distance between rows, in spacings.
constexpr double row_height = std::numbers::sqrt3 / 2;

/// The ratio of rows to columns with which the lattice would fit this box exactly.
double shape_of(const Box& box, Axis axis) {
    return along(other_axis(axis), box) / along(axis, box) / row_height;
}

} // namespace

double TriangularLattice::nearest() const {
    return std::min(columns > 1 ? spacing : std::numeric_limits<double>::infinity(),
                    std::sqrt(spacing * spacing / 4 + height * height));
}

/// Even rows begin, and odd rows end, a quarter of a spacing from an edge of the box.
Point TriangularLattice::site(DiscId id) const {
    const std::uint64_t row = id / columns, column = id % columns;
    const double shift = row % 2 == 0 ? 0.25 : 0.75;
    const auto [x, y] = turned(axis, (static_cast<double>(column) + shift) * spacing,
                               (static_cast<double>(row) + 0.5) * height);
    return {x, y};
}

std::optional<TriangularLattice> triangular_lattice(std::uint64_t n_discs, const Box& box) {
    std::optional<TriangularLattice> best;
    double least = largest_stretch;
    for (const Axis axis : {longer_axis(box), other_axis(longer_axis(box))}) {
        const double shape = shape_of(box, axis);
        const double usual = std::sqrt(static_cast<double>(n_discs) / shape);
        const auto last = static_cast<std::uint64_t>(std::ceil(usual * (1 + largest_stretch)));
        auto columns = static_cast<std::uint64_t>(usual * (1 - largest_stretch));
        for (columns = std::max<std::uint64_t>(1, columns); columns <= last; ++columns) {
            const std::uint64_t rows = n_discs / columns;
            if (columns * rows != n_discs || rows % 2 != 0) continue;
            const auto n = static_cast<double>(columns), m = static_cast<double>(rows);
            const double stretch = std::fabs(m / n / shape - 1);
            if (!(stretch <= least)) continue;
            least = stretch;
            best = {columns, rows, axis, along(axis, box) / n, along(other_axis(axis), box) / m};
        }
    }
    return best;
}

std::string nearest_triangular(std::uint64_t n_discs, const Box& box) {
    const auto n = static_cast<double>(n_discs);
    double least = std::numeric_limits<double>::infinity();
    std::string text;
    for (const Axis axis : {longer_axis(box), other_axis(longer_axis(box))}) {
        const double shape = shape_of(box, axis);
        const double usual_columns = std::floor(std::sqrt(n / shape));
        for (double columns = std::max(1.0, usual_columns - 2); columns <= usual_columns + 3;
             ++columns) {
            const double usual_rows = 2 * std::round(columns * shape / 2);
            for (const double rows : {usual_rows - 2, usual_rows, usual_rows + 2}) {
                if (rows < 2) continue;
                const double change = std::fabs(std::log(rows * columns / n)) +
                                      std::fabs(std::log(rows / columns / shape));
                if (!(change < least)) continue;
                least = change;
                const double length = along(axis, box);
                const auto [x, y] = turned(axis, length, length / columns * rows * row_height);
                text = fmt::format("discs.count = {}, box.size = [{:.10g}, {:.10g}] ({} x {})",
                                   columns * rows, x, y, columns, rows);
            }
        }
    }
    return text;
}

} // namespace carrom
