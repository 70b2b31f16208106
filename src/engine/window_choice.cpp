// SPDX-License-Identifier: BSD-3-Clause
#include "engine/window_choice.hpp"

#include <algorithm>
#include <cmath>

namespace carrom {

namespace {

// Times in nanoseconds on one core if the discs are in the cache. If they are in main memory, all
// times are about 1.2 times as long.
constexpr double disc = 30;     ///< time for each disc in a window, however long the window is
constexpr double partner = 1.3; ///< time per disc, for each other disc in a square of side reach
/// Time to predict the next collision of a disc that has collided inside the window
constexpr double hit = 85;
/// Time per such collision, for each other disc in a square whose side is the reach
constexpr double hit_partner = 3;
/// Time for each disc in a part of a micro-step, including the work at the end of the part.
constexpr double disc_in_part = 65;
/// Time per disc in a part of a micro-step, for each other disc in this square; small, because most
/// pairs are rejected early.
constexpr double partner_in_part = 0.7;
constexpr double fast_disc = 200;  ///< time for each fast disc in a part of a micro-step
constexpr double fast_partner = 1; ///< time for each disc in cells along a fast disc's path
/// Time for each pair of fast discs; small, because fast discs lie side by side in memory.
constexpr double fast_pair = 0.1;
constexpr double largest_fast_share = 0.1;

double cost_per_micro_step(const WindowNeeds& needs, double duration) {
    const double reach = reach_of(needs, duration);
    const double in_reach = needs.n_discs * (std::min(reach, needs.box.x) / needs.box.x) *
                            (std::min(reach, needs.box.y) / needs.box.y);
    const bool is_part = duration < 1;
    const double once = ((is_part ? disc_in_part : disc) +
                         (is_part ? partner_in_part : partner) * in_reach) /
                        duration;
    const double again = needs.hits_per_micro_step * (hit + hit_partner * in_reach);
    return duration > 1 ? once + again * (1 - 1 / duration) : once;
}

/// The cost of a micro-step that is divided into parts, if the fraction `share` of the discs is
/// faster than `usual_speed`.
double cost_with_fast_discs(const WindowNeeds& needs, double duration, double usual_speed,
                            double share) {
    WindowNeeds usual = needs;
    usual.largest_speed = usual_speed;
    const double reach = reach_of(usual, duration), density = needs.n_discs / needs.box.area();
    const double side = 1.5 * reach + 0.32 * (usual_speed + needs.largest_speed) * duration;
    const double each = fast_disc +
                        fast_partner * density * std::min(needs.box.x, side) *
                            std::min(needs.box.y, side) +
                        fast_pair * share * needs.discs_per_rank;
    return cost_per_micro_step(usual, duration) + share * each / duration;
}

} // namespace

SpeedSpread::SpeedSpread(const Counts& counts, double largest_speed) : largest(largest_speed) {
    std::uint64_t n_faster = 0;
    for (std::size_t k = n_parts; k-- > 0;) {
        n_faster += counts[k];
        share_above[k] = static_cast<double>(n_faster);
    }
    for (double& share : share_above)
        share /= static_cast<double>(std::max<std::uint64_t>(1, n_faster));
}

double SpeedSpread::mean() const {
    double parts = 0.5;
    for (std::size_t k = 1; k < n_parts; ++k) parts += share_above[k];
    return largest * parts / n_parts;
}

double guess_of_hits(const WindowNeeds& needs) {
    if (!needs.spread) return 0;
    const double relative_speed = std::sqrt(2.0) * needs.spread->mean(),
                 density = needs.n_discs / needs.box.area();
    return std::min(1.0, 2 * density * 2 * needs.radius * relative_speed);
}

double reach_of(const WindowNeeds& needs, double duration) {
    return reach_of(needs, duration, needs.largest_speed);
}

double reach_of(const WindowNeeds& needs, double duration, double speed) {
    const double from_anchor = duration > 1 ? duration : duration / 2; // longest time from anchor
    return (2 * needs.radius + 2 * speed * from_anchor) * (1 + 1e-6) +
           64 * 0x1p-53 * needs.box.longest();
}

WindowChoice choose_window(const WindowNeeds& needs, int n_left, std::optional<double> wanted) {
    if (wanted) {
        if (*wanted >= 1)
            return {std::clamp(static_cast<int>(*wanted), 1, n_left), 1, needs.largest_speed};
        return {1, static_cast<int>(std::clamp(std::ceil(1 / *wanted), 1.0, 1e6)),
                needs.largest_speed};
    }
    WindowChoice best{1, 1, needs.largest_speed};
    double least = cost_per_micro_step(needs, 1);
    const auto try_choice = [&](WindowChoice choice, double cost) {
        if (cost >= least) return;
        least = cost;
        best = choice;
    };
    for (int n = 2; n <= n_left; ++n)
        try_choice({n, 1, needs.largest_speed}, cost_per_micro_step(needs, n));
    for (int n = 2; n <= 100000 && n * disc_in_part < least; n += std::max(1, n / 16)) {
        const double duration = 1.0 / n;
        try_choice({1, n, needs.largest_speed}, cost_per_micro_step(needs, duration));
        for (std::size_t k = 1; needs.spread && k < SpeedSpread::n_parts; ++k) {
            const double usual = needs.spread->speed_of(k), share = needs.spread->share_above[k];
            if (share > largest_fast_share || usual >= needs.largest_speed) continue;
            try_choice({1, n, usual}, cost_with_fast_discs(needs, duration, usual, share));
        }
    }
    return best;
}

} // namespace carrom
