// SPDX-License-Identifier: BSD-3-Clause
#include "window_choice.hpp"

#include <algorithm>
#include <cmath>

namespace carrom {

namespace {

// Measured on one core at packing 0.2, in nanoseconds: what a disc costs per window whatever its length, and what each
// disc within a square of one reach costs on top (docs/performance.md).
constexpr double cost_per_disc = 40;
constexpr double cost_per_partner = 2.5;

double cost_per_time(const WindowNeeds& needs, double duration) {
    const double reach = std::min(reach_of(needs, duration), needs.box_size);
    const double in_reach = needs.n_discs * (reach / needs.box_size) * (reach / needs.box_size);
    return (cost_per_disc + cost_per_partner * in_reach) / duration;
}

} // namespace

double reach_of(const WindowNeeds& needs, double duration) {
    return (2 * needs.radius + 2 * needs.largest_speed * duration) * (1 + 1e-6) + 64 * 0x1p-53 * needs.box_size;
}

WindowChoice choose_window(const WindowNeeds& needs, int n_left, std::optional<double> wanted) {
    if (wanted) {
        if (*wanted >= 1) return {std::clamp(static_cast<int>(*wanted), 1, n_left), 1};
        return {1, static_cast<int>(std::clamp(std::ceil(1 / *wanted), 1.0, 1e6))};
    }
    WindowChoice best;
    double least = cost_per_time(needs, 1);
    for (int n = 2; n <= n_left; ++n) {
        const double cost = cost_per_time(needs, n);
        if (cost > least) break; // the cost has a single minimum
        least = cost;
        best = {n, 1};
    }
    if (best.n_micro > 1) return best;
    for (int n = 2; n <= 100000; n += std::max(1, n / 16)) {
        const double cost = cost_per_time(needs, 1.0 / n);
        if (cost > least) break;
        least = cost;
        best = {1, n};
    }
    return best;
}

} // namespace carrom
