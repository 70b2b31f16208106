// SPDX-License-Identifier: BSD-3-Clause
#include "window_choice.hpp"

#include <algorithm>
#include <cmath>

namespace carrom {

namespace {

/// In nanoseconds, on one core (docs/performance.md).
struct Costs {
    double disc;        ///< of a disc in a window of any length
    double partner;     ///< and of each disc within a square of one reach
    double hit;         ///< of predicting a disc again that was hit inside the window
    double hit_partner; ///< and of each disc within a square of one reach
};
constexpr Costs in_cache{30, 1.3, 85, 3}, in_memory{60, 1.3, 370, 7};
constexpr double discs_in_cache = 200'000; // a rank's, in its share of the last cache

double cost_per_micro_step(const WindowNeeds& needs, double duration) {
    const Costs& cost = needs.discs_per_rank > discs_in_cache ? in_memory : in_cache;
    const double reach = std::min(reach_of(needs, duration), needs.box_size);
    const double in_reach = needs.n_discs * (reach / needs.box_size) * (reach / needs.box_size);
    const double once = (cost.disc + cost.partner * in_reach) / duration;
    const double again = needs.hits_per_micro_step * (cost.hit + cost.hit_partner * in_reach);
    return duration > 1 ? once + again * (1 - 1 / duration) : once;
}

} // namespace

double reach_of(const WindowNeeds& needs, double duration) {
    const double from_anchor = duration > 1 ? duration : duration / 2; // see Window::anchor
    return (2 * needs.radius + 2 * needs.largest_speed * from_anchor) * (1 + 1e-6) + 64 * 0x1p-53 * needs.box_size;
}

WindowChoice choose_window(const WindowNeeds& needs, int n_left, std::optional<double> wanted) {
    if (wanted) {
        if (*wanted >= 1) return {std::clamp(static_cast<int>(*wanted), 1, n_left), 1};
        return {1, static_cast<int>(std::clamp(std::ceil(1 / *wanted), 1.0, 1e6))};
    }
    WindowChoice best;
    double least = cost_per_micro_step(needs, 1);
    const auto try_choice = [&](WindowChoice choice) {
        const double cost = cost_per_micro_step(needs, static_cast<double>(choice.n_micro) / choice.n_parts);
        if (cost >= least) return;
        least = cost;
        best = choice;
    };
    for (int n = 2; n <= n_left; ++n) try_choice({n, 1});
    for (int n = 2; n <= 100000; n += std::max(1, n / 16)) try_choice({1, n});
    return best;
}

} // namespace carrom
