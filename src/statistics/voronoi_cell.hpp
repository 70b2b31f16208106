// SPDX-License-Identifier: BSD-3-Clause
// The Voronoi cell of one point, the origin: a polygon that is cut by the bisectors to other
// points, or by their radical axes if points have sizes. The arithmetic has a fixed order, so the
// same points in the same order give the same bits.
#pragma once

#include <cstddef>
#include <vector>

namespace carrom {

class VoronoiCell {
public:
    static constexpr int no_point = -1;

    /// Starts with a rectangle around the origin, whose sides belong to no point.
    void begin(double left, double right, double bottom, double top);
    /// Cuts off the part that is closer to the point (dx, dy) than to the origin; `point` is the
    /// point's number. `larger` is the squared radius of the disc at the origin minus that of the
    /// disc at the point. Distances to discs are the lengths of tangents.
    void cut(double dx, double dy, int point, double larger = 0);
    /// The squared distance of the farthest corner. If all sizes are equal, points at more than
    /// twice the distance of this corner do not cut the cell.
    double squared_radius() const;

    /// Calls `visit(point, squared_length)` for each side, in order around the cell.
    template <class Visit> void for_each_side(const Visit& visit) const {
        for (std::size_t k = 0; k < corners_.size(); ++k) {
            const Corner &a = corners_[k], &b = corners_[k + 1 < corners_.size() ? k + 1 : 0];
            visit(a.point, (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
        }
    }

private:
    struct Corner {
        double x = 0, y = 0;
        /// The point whose bisector is the side from here to the next corner, counterclockwise
        int point = no_point;
    };

    std::vector<Corner> corners_, before_;
};

} // namespace carrom
