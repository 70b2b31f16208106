// SPDX-License-Identifier: BSD-3-Clause
#include "hard_cases.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include "standard_streams.hpp"

namespace carrom {

void warn_of_hard_cases(const Scene& scene, const Simulation& simulation, const Communicator& ranks) {
    double square = 0;
    for (const Disc& disc : simulation.discs()) square = std::max(square, disc.vx * disc.vx + disc.vy * disc.vy);
    const double speed = std::sqrt(ranks.max(square));
    const double rounding = static_cast<double>(scene.sync_every) * 0x1p-53; // times count from the last sync
    // As far as the band before walls is wide: from there on bounces and overlaps show it.
    if (!ranks.is_root() || speed * rounding <= 1e-8 * scene.radius) return;
    tell("{}: warning: the fastest disc goes {:.3g} radii per micro-step, and {:.3g} radii in the rounding of a time; "
         "more time.micro_steps or a smaller time.sync_every (now {}) keep overlaps smaller\n",
         scene.name, speed / scene.radius, speed * rounding / scene.radius, scene.sync_every);
}

void warn_of_close_pairs(const Scene& scene, const Totals& start) {
    const auto pairs = [](std::uint64_t count) { return count == 1 ? std::string("1 pair") : fmt::format("{} pairs", count); };
    if (start.overlapping_pairs > 0)
        tell("{}: warning: {} of discs overlap at the start; they pass through each other and collide once they have come apart\n",
             scene.name, pairs(start.overlapping_pairs));
    if (start.chained_discs > 0)
        tell("{}: warning: {} two others or more at the start; what a hit does to discs that touch mechanics does not define: "
             "here the order of ids does\n",
             scene.name, start.chained_discs == 1 ? "1 disc touches" : fmt::format("{} discs touch", start.chained_discs));
    if (start.sliding_pairs > 0)
        tell("{}: warning: {} of discs that touch slide along each other at the start; whether they collide the last digits decide\n",
             scene.name, pairs(start.sliding_pairs));
}

} // namespace carrom
