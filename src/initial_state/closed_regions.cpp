// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/closed_regions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "dynamics/container.hpp"
#include "initial_state/narrow_gaps.hpp"

namespace carrom {

namespace {

/// Distance between neighbouring points, in smallest radii. It must be below 2/3: of two neighbours
/// on different sides of a segment, at least one is then so near to it that it is blocked.
constexpr double spacing = 0.66;
constexpr double most_points = 0x1p22;

double smallest_radius(const SceneParameters& scene) {
    double radius = scene.radius;
    for (const Species& one : scene.effects.species) radius = std::min(radius, one.radius);
    return radius;
}

class Regions {
public:
    explicit Regions(const SceneParameters& scene)
        : box_(scene.box), is_periodic_x_(scene.effects.is_periodic_x()),
          is_periodic_y_(scene.effects.is_periodic_y()) {
        const double width = spacing * smallest_radius(scene);
        if (box_.x / width * (box_.y / width) > most_points) return;
        n_columns_ = static_cast<std::int64_t>(std::ceil(box_.x / width));
        n_rows_ = static_cast<std::int64_t>(std::ceil(box_.y / width));
        region_of_.assign(static_cast<std::size_t>(n_columns_ * n_rows_), unknown);
        const double clear = smallest_radius(scene) - width;
        for (const FixedDisc& disc : scene.effects.fixed_bodies.discs)
            block({disc.x, disc.y, disc.x, disc.y}, disc.radius + clear);
        for (const Segment& segment : all_segments(scene.effects.fixed_bodies, box_))
            block(segment, clear);
        for (const Arc& arc : all_arcs(scene.effects.fixed_bodies, box_))
            for (const Segment& chord : chords_of(arc, width / 4)) block(chord, clear);
        for (const Segment& line : lines_across_narrow_gaps(scene, smallest_radius(scene)))
            block(line, clear);
        block_outside(Container(scene.effects.fixed_bodies.shape, box_));
        for (std::size_t k = 0; k < region_of_.size(); ++k)
            if (region_of_[k] == unknown) sizes_.push_back(fill(k));
        largest_ = static_cast<std::int32_t>(std::ranges::max_element(sizes_) - sizes_.begin());
        let_out(scene.effects);
    }

    bool are_several() const { return sizes_.size() > 1; }
    std::size_t n() const { return sizes_.size(); }
    /// The number of the closed region in which the position lies; -1 if it is in no closed region.
    std::int32_t closed_region(double x, double y) const {
        const std::int32_t region = region_of_[index(column_of(x), row_of(y))];
        const bool is_shut = region >= 0 && region != largest_ &&
                             sizes_[static_cast<std::size_t>(region)] > 0;
        return is_shut ? region : -1;
    }

private:
    static constexpr std::int32_t unknown = -2, blocked = -1;

    std::size_t index(std::int64_t column, std::int64_t row) const {
        return static_cast<std::size_t>(column * n_rows_ + row);
    }
    std::int64_t column_of(double x) const {
        return std::clamp<std::int64_t>(
            static_cast<std::int64_t>(x / box_.x * static_cast<double>(n_columns_)), 0,
            n_columns_ - 1);
    }
    std::int64_t row_of(double y) const {
        return std::clamp<std::int64_t>(
            static_cast<std::int64_t>(y / box_.y * static_cast<double>(n_rows_)), 0, n_rows_ - 1);
    }
    double x_of(std::int64_t column) const {
        return (static_cast<double>(column) + 0.5) * box_.x / static_cast<double>(n_columns_);
    }
    double y_of(std::int64_t row) const {
        return (static_cast<double>(row) + 0.5) * box_.y / static_cast<double>(n_rows_);
    }

    /// Blocks the points outside of a box that is not a rectangle.
    void block_outside(const Container& container) {
        if (container.is_rectangle()) return;
        for (std::int64_t column = 0; column < n_columns_; ++column)
            for (std::int64_t row = 0; row < n_rows_; ++row)
                if (container.outside(x_of(column), y_of(row)) > 0)
                    region_of_[index(column, row)] = blocked;
    }
    /// Blocks the points nearer than `distance` to a segment or to its periodic images.
    void block(const Segment& segment, double distance) {
        for (const double dx : {-box_.x, 0.0, box_.x})
            for (const double dy : {-box_.y, 0.0, box_.y}) {
                if ((dx != 0 && !is_periodic_x_) || (dy != 0 && !is_periodic_y_)) continue;
                block_image({segment.x0 + dx, segment.y0 + dy, segment.x1 + dx, segment.y1 + dy},
                            distance);
            }
    }
    void block_image(const Segment& segment, double distance) {
        const double ex = segment.x1 - segment.x0, ey = segment.y1 - segment.y0,
                     square = ex * ex + ey * ey;
        const auto [x_low, x_high] = std::minmax(segment.x0, segment.x1);
        const auto [y_low, y_high] = std::minmax(segment.y0, segment.y1);
        if (x_high + distance < 0 || x_low - distance > box_.x || y_high + distance < 0 ||
            y_low - distance > box_.y)
            return;
        for (std::int64_t i = column_of(x_low - distance); i <= column_of(x_high + distance); ++i)
            for (std::int64_t j = row_of(y_low - distance); j <= row_of(y_high + distance); ++j) {
                const double x = x_of(i) - segment.x0, y = y_of(j) - segment.y0;
                const double along = square > 0 ? std::clamp((x * ex + y * ey) / square, 0.0, 1.0)
                                                : 0;
                if (std::hypot(x - along * ex, y - along * ey) < distance)
                    region_of_[index(i, j)] = blocked;
            }
    }

    /// Assigns the next region number to all points that are connected with point `first`. Returns
    /// the number of these points.
    std::uint64_t fill(std::size_t first) {
        const auto number = static_cast<std::int32_t>(sizes_.size());
        std::uint64_t n_points = 0;
        region_of_[first] = number;
        to_visit_.assign(1, first);
        while (!to_visit_.empty()) {
            const auto at = static_cast<std::int64_t>(to_visit_.back());
            to_visit_.pop_back();
            n_points += 1;
            const std::int64_t column = at / n_rows_, row = at % n_rows_;
            go_to(column - 1, row, number);
            go_to(column + 1, row, number);
            go_to(column, row - 1, number);
            go_to(column, row + 1, number);
        }
        return n_points;
    }
    void go_to(std::int64_t column, std::int64_t row, std::int32_t number) {
        if (is_periodic_x_) column = (column + n_columns_) % n_columns_;
        if (is_periodic_y_) row = (row + n_rows_) % n_rows_;
        if (column < 0 || column >= n_columns_ || row < 0 || row >= n_rows_) return;
        std::int32_t& region = region_of_[index(column, row)];
        if (region != unknown) return;
        region = number;
        to_visit_.push_back(index(column, row));
    }

    /// Sets the size of regions at open sides to 0, so that they do not count as closed.
    void let_out(const Effects& effects) {
        const auto is_open = [&](std::size_t side) {
            return effects.boundaries[side].kind == BoundaryKind::open;
        };
        const auto let_out_at = [&](std::int64_t column, std::int64_t row) {
            const std::int32_t region = region_of_[index(column, row)];
            if (region >= 0) sizes_[static_cast<std::size_t>(region)] = 0;
        };
        for (std::int64_t row = 0; row < n_rows_; ++row) {
            if (is_open(0)) let_out_at(0, row);
            if (is_open(1)) let_out_at(n_columns_ - 1, row);
        }
        for (std::int64_t column = 0; column < n_columns_; ++column) {
            if (is_open(2)) let_out_at(column, 0);
            if (is_open(3)) let_out_at(column, n_rows_ - 1);
        }
    }

    Box box_;
    bool is_periodic_x_, is_periodic_y_;
    std::int64_t n_columns_ = 0, n_rows_ = 0;
    /// Region number of each point; points are sorted by column, then by row
    std::vector<std::int32_t> region_of_;
    std::vector<std::uint64_t> sizes_; ///< number of points in each region; 0 at an open side
    std::vector<std::size_t> to_visit_;
    std::int32_t largest_ = 0;
};

} // namespace

ShutInDiscs find_shut_in(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                         const Communicator& communicator) {
    ShutInDiscs found;
    if (!scene.effects.fixed_bodies.are_any()) return found;
    const Regions regions(scene);
    if (!regions.are_several()) return found;
    std::vector<std::uint64_t> n_discs(regions.n());
    for (const InputDisc& disc : discs)
        if (const std::int32_t region = regions.closed_region(disc.x, disc.y); region >= 0)
            n_discs[static_cast<std::size_t>(region)] += 1;
    communicator.sum(std::span(n_discs));
    for (const std::uint64_t n : n_discs) {
        found.n_discs += n;
        found.n_regions += n > 0;
    }
    return found;
}

} // namespace carrom
