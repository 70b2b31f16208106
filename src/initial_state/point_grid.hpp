// SPDX-License-Identifier: BSD-3-Clause
// A grid of square cells at least `reach` wide, so that all points within `reach` of a position lie
// in its cell or in the eight cells around. Each cell has a linked list of its points, so adding a
// point is O(1). Memory: 4 bytes for each point, and 4 for each cell.
//
// The grid stores only the points' numbers. The caller keeps the coordinates and decides which
// points are near. Clearing takes a time proportional to the number of points, not of cells.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/raw_vector.hpp"
#include "lattices/lattice.hpp"

namespace carrom {

class PointGrid {
public:
    /// Covers [x_low, x_high] x [0, height]. There are about two cells for each of `n_points`
    /// points, or fewer, because cells are at least `reach` wide.
    PointGrid(double x_low, double x_high, double height, double reach, double n_points)
        : x_low_(x_low) {
        const double width = std::max(x_high - x_low, reach);
        // A cell is wider than `reach` by more than the rounding in `column` and `row`.
        const double cell = std::max(reach * (1 + 1e-9),
                                     std::sqrt(width * height / (2 * n_points + 1)));
        per_length_ = 1 / cell;
        columns_ = static_cast<std::uint64_t>(width * per_length_) + 1;
        rows_ = static_cast<std::uint64_t>(height * per_length_) + 1;
        heads_.assign(columns_ * rows_, none);
        // Reserves all memory now, because a growing list is copied and so needs more than twice
        // its size. Reserved memory takes no space before it is used.
        next_.reserve(static_cast<std::size_t>(1.1 * n_points) + 100);
    }

    /// Adds the next point, whose number is the count of points before it.
    void add(Point point) {
        std::uint32_t& head = heads_[cell_of(point)];
        next_.push_back(head);
        head = static_cast<std::uint32_t>(next_.size() - 1);
    }

    /// Adds those points of `points` that come after the points added before. The order in a cell's
    /// list depends on the threads.
    template <class Points> void add_rest(const Points& points, int n_threads) {
        const std::size_t first = next_.size();
        next_.resize(points.size());
#pragma omp parallel for num_threads(n_threads) schedule(static)
        for (std::size_t k = first; k < points.size(); ++k) {
            std::uint32_t& head = heads_[cell_of({points[k].x, points[k].y})];
            const auto number = static_cast<std::uint32_t>(k);
            next_[k] = n_threads == 1
                           ? std::exchange(head, number)
                           : std::atomic_ref(head).exchange(number, std::memory_order_relaxed);
        }
    }

    /// Whether `is_hit(number)` is true for at least one point in the 9 cells around `place`.
    template <class IsHit> bool any_near(Point place, const IsHit& is_hit) const {
        const std::uint64_t c = column(place.x), r = row(place.y);
        const std::uint64_t last_column = std::min(c + 1, columns_ - 1),
                            last_row = std::min(r + 1, rows_ - 1);
        for (std::uint64_t i = c - (c > 0); i <= last_column; ++i)
            for (std::uint64_t j = r - (r > 0); j <= last_row; ++j)
                for (std::uint32_t k = heads_[i * rows_ + j]; k != none; k = next_[k])
                    if (is_hit(k)) return true;
        return false;
    }

    /// Removes all points; `points` must be those that were added.
    template <class Points> void clear(const Points& points, int n_threads) {
#pragma omp parallel for num_threads(n_threads) schedule(static)
        for (std::size_t k = 0; k < points.size(); ++k)
            std::atomic_ref(heads_[cell_of({points[k].x, points[k].y})])
                .store(none, std::memory_order_relaxed);
        next_.clear();
    }

private:
    static constexpr std::uint32_t none = 0xFFFFFFFFu;

    std::uint64_t cell_of(Point point) const { return column(point.x) * rows_ + row(point.y); }
    std::uint64_t column(double x) const { return place((x - x_low_) * per_length_, columns_); }
    std::uint64_t row(double y) const { return place(y * per_length_, rows_); }
    static std::uint64_t place(double cells, std::uint64_t n) {
        return std::min(static_cast<std::uint64_t>(std::max(cells, 0.0)), n - 1);
    }

    double x_low_, per_length_ = 0;
    std::uint64_t columns_ = 0, rows_ = 0;
    std::vector<std::uint32_t> heads_;
    RawVector<std::uint32_t> next_;
};

} // namespace carrom
