// SPDX-License-Identifier: BSD-3-Clause
#include "engine/stretch_room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/near_pairs.hpp"

namespace carrom {

StretchRange stretch_room(const Population& population, const CellGrid& grid,
                          const Touching& touching, double margin, const Communicator& communicator,
                          int n_threads) {
    double least = 0, most = std::numeric_limits<double>::infinity(); // bounds of t^2
    const int n_columns = grid.geometry().n_columns;
#pragma omp parallel for num_threads(n_threads) schedule(dynamic, 8) reduction(max : least)        \
    reduction(min : most)
    for (int column = 0; column < n_columns; ++column) {
        visit_near_pairs_of(grid, column, [&](LocalIndex a, LocalIndex b) {
            if (population.discs[b].id < population.discs[a].id) std::swap(a, b);
            const DiscState &p = population.discs[a], &q = population.discs[b];
            const Shift shift = touching.periods.between(p, q, 0);
            const double dx = (q.x - p.x) + shift.x, dy = (q.y - p.y) + shift.y,
                         diameter = touching.diameter_of(p, q) + margin, wide = dx * dx,
                         high = dy * dy, square = diameter * diameter,
                         roots = square * square - 4 * wide * high;
            if (!(roots >= 0)) return;
            const double sum = square + std::sqrt(roots);
            if (wide > high)
                least = std::max(least, sum / (2 * wide));
            else
                most = std::min(most, 2 * high / sum);
        });
    }
    return {std::min(std::sqrt(communicator.max(least)), 1.0),
            std::max(std::sqrt(communicator.min(most)), 1.0)};
}

} // namespace carrom
