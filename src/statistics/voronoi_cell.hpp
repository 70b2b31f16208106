// SPDX-License-Identifier: BSD-3-Clause
// The Voronoi cell of one point, the origin: a polygon that is cut by the bisectors to
// other points, or by their radical axes where points have sizes. Plain arithmetic in a
// fixed order, so the same points in the same order give the same bits.
#pragma once

#include <cstddef>
#include <vector>

namespace carrom {

class VoronoiCell {
public:
    static constexpr int no_point = -1;

    /// Begins with a rectangle around the origin, whose sides belong to no point.
    void begin(double left, double right, double bottom, double top);
    /// Cuts off all places closer to the point (dx, dy) than to the origin; `point` is its number.
    /// `larger` is the square of the origin's radius less that of the point's: distances count as
    /// the lengths of tangents to discs of these radii.
    void cut(double dx, double dy, int point, double larger = 0);
    /// The squared distance of the farthest corner. Points at twice that distance cut nothing.
    double squared_radius() const;

    /// Calls `visit(point, squared_length)` for each side, in their order around the cell.
    template <class Visit> void for_each_side(const Visit& visit) const {
        for (std::size_t k = 0; k < corners_.size(); ++k) {
            const Corner &a = corners_[k], &b = corners_[k + 1 < corners_.size() ? k + 1 : 0];
            visit(a.point, (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
        }
    }

private:
    struct Corner {
        double x = 0, y = 0;
        int point = no_point; ///< the side from here to the next corner, counterclockwise
    };

    std::vector<Corner> corners_, before_;
};

} // namespace carrom
