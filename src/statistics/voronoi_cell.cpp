// SPDX-License-Identifier: BSD-3-Clause
#include "statistics/voronoi_cell.hpp"

#include <algorithm>
#include <utility>

namespace carrom {

void VoronoiCell::begin(double left, double right, double bottom, double top) {
    corners_ = {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

void VoronoiCell::cut(double dx, double dy, int point, double larger) {
    const double half = ((dx * dx + dy * dy) + larger) / 2;
    const auto beyond = [=](const Corner& c) { return c.x * dx + c.y * dy - half; };
    std::swap(corners_, before_);
    corners_.clear();
    for (std::size_t k = 0; k < before_.size(); ++k) {
        const Corner &a = before_[k], &b = before_[k + 1 < before_.size() ? k + 1 : 0];
        const double at_a = beyond(a), at_b = beyond(b);
        if (at_a <= 0) corners_.push_back(a);
        if ((at_a <= 0) == (at_b <= 0)) continue;
        const double t = at_a / (at_a - at_b);
        corners_.push_back(
            {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), at_a <= 0 ? point : a.point});
    }
}

double VoronoiCell::squared_radius() const {
    double largest = 0;
    for (const Corner& c : corners_) largest = std::max(largest, c.x * c.x + c.y * c.y);
    return largest;
}

} // namespace carrom
