// SPDX-License-Identifier: BSD-3-Clause
#include "carrom/domain/place_bounds.hpp"

#include <algorithm>
#include <limits>

namespace carrom {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

void PlaceBounds::survey(std::span<const Disc> discs, double time) {
    bounds_.resize(discs.size() / in_a_row);
    for (std::size_t k = 0; k < bounds_.size(); ++k) {
        Bounds bounds{infinity, -infinity};
        for (const Disc& disc : discs.subspan(k * in_a_row, in_a_row)) {
            const double x = disc.x_at(time);
            bounds.low = std::min(bounds.low, x);
            bounds.high = std::max(bounds.high, x);
        }
        bounds_[k] = bounds;
    }
    moved_ = 0;
    are_known_ = true;
}

void PlaceBounds::replace(std::size_t place) {
    if (place / in_a_row < bounds_.size()) bounds_[place / in_a_row] = {-infinity, infinity};
}

void PlaceBounds::truncate(std::size_t n_places) { bounds_.resize(std::min(bounds_.size(), n_places / in_a_row)); }

std::vector<PlaceRange> PlaceBounds::outside(double low, double high, std::size_t n_places) const {
    std::vector<PlaceRange> ranges;
    const auto add = [&ranges](std::size_t begin, std::size_t end) {
        if (!ranges.empty() && ranges.back().end == begin) ranges.back().end = end;
        else if (begin < end) ranges.push_back({begin, end});
    };
    const std::size_t n_known = are_known_ ? std::min(bounds_.size(), n_places / in_a_row) : 0;
    for (std::size_t k = 0; k < n_known; ++k) {
        const bool are_inside = bounds_[k].low - moved_ >= low && bounds_[k].high + moved_ < high;
        if (!are_inside) add(k * in_a_row, (k + 1) * in_a_row);
    }
    add(n_known * in_a_row, n_places);
    return ranges;
}

} // namespace carrom
