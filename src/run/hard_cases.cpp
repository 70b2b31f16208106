// SPDX-License-Identifier: BSD-3-Clause
#include "run/hard_cases.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "engine/long_flights.hpp"

namespace carrom {

namespace {

/// The speed of the fastest disc on any rank, in lengths per micro-step. **Collective.**
double largest_speed(const DiscSystem& system, const Communicator& ranks) {
    double square = 0;
    for (const DiscState& disc : system.discs())
        square = std::max(square, disc.vx * disc.vx + disc.vy * disc.vy);
    return std::sqrt(ranks.max(square));
}

/// The largest number of box lengths that the fastest disc may fly between syncs. Counters have 15
/// bits (core/image.hpp), and collisions may double this disc's speed.
constexpr double most_crossings = 8000;

void refuse_long_flights(const SceneParameters& scene, double speed, double up) {
    if (!scene.effects.are_periodic()) return;
    const double interval = static_cast<double>(
        std::min(scene.sync_every, scene.steps * scene.micro_steps));
    Periods periods = scene.effects.periods(scene.box);
    periods.speed /= static_cast<double>(scene.micro_steps);
    const double crossings = most_lengths(periods, speed, up, interval);
    if (crossings <= most_crossings) return;
    throw InputError({{scene.name, 0,
                       fmt::format("the fastest disc flies {:.3g} times through the box with "
                                   "periodic sides from one sync to the next; this version "
                                   "counts to {:g}: take a smaller time.sync_every (now {}) or "
                                   "{:.3g} times as many time.micro_steps",
                                   crossings, most_crossings, scene.sync_every,
                                   std::ceil(crossings / most_crossings))}});
}

/// The distance that a disc flies in a time as long as the rounding error of times, which count
/// from the last sync.
double blurred_flight(const SceneParameters& scene, double speed) {
    return speed * static_cast<double>(scene.sync_every) * 0x1p-53;
}

/// Throws if rounding of times moves a disc by more than a radius, because contacts would then be
/// meaningless.
void refuse_blurred_places(const SceneParameters& scene, double speed) {
    const double radii = blurred_flight(scene, speed) / scene.radius;
    if (radii <= 1) return;
    throw InputError(
        {{scene.name, 0,
          fmt::format("the fastest disc goes {:.3g} radii per micro-step, and {:.3g} radii in the "
                      "rounding of a time, so where it meets others is unknown; take smaller "
                      "speeds or {:.3g} times as many time.micro_steps",
                      speed / scene.radius, radii, std::ceil(radii))}});
}

/// The largest number of ranks, at least 1, for which halos have no more discs than domains. At a
/// packing of 0.5 a rank fetches discs from up to h = 8 mean distances away: 16 strips of 1250
/// discs, 8.8 such distances wide, have 1.65 discs in the halo for each disc inside
/// (tests/performance/rank_loads.csv). With its halo, a strip of width w covers the width w + 2 h,
/// and a square of side s covers (s + 2 h)^2. Halo and domain have equal areas for a strip with w =
/// 2 h = 16, and for a square with s = 2 h / (sqrt(2) - 1) = 39, which has 1500 discs.
double most_ranks_of(const SceneParameters& scene) {
    constexpr double both_sides = 2 * 8;
    constexpr double least_square = both_sides / (std::numbers::sqrt2 - 1);
    const double n_discs = static_cast<double>(scene.n_discs);
    const double length = std::sqrt(n_discs * scene.box.longest() / scene.box.shortest());
    return std::max({1.0, std::floor(length / both_sides),
                     std::floor(n_discs / (least_square * least_square))});
}

/// The smallest number of threads, at least `least`, that divides the number of cores, so that
/// every core has a thread.
int threads_that_fill(int n_cores, int least) {
    int threads = least;
    while (n_cores % threads != 0) threads += 1;
    return threads;
}

} // namespace

void refuse_hard_cases(const SceneParameters& scene, const DiscSystem& system,
                       const Communicator& ranks, const Messages& messages) {
    const double speed = largest_speed(system, ranks);
    refuse_blurred_places(scene, speed);
    // In shear the flow along x is much faster than motion along y, so y has a limit of its own
    const bool is_flow = scene.effects.are_sheared();
    refuse_long_flights(scene, speed, is_flow ? ranks.max(fastest_up(system.discs())) : speed);
    const double blur = blurred_flight(scene, speed);
    // An error below 1e-8 r, the tolerance of contacts with walls, does not affect bounces and
    // overlaps. Discs of radius 0 only have to stay on their side of a wall.
    if (blur <= (scene.are_points ? 0.1 : 1e-8) * scene.radius) return;
    messages.warn(
        "{}: warning: the fastest disc goes {:.3g} radii per micro-step, and {:.3g} radii in the "
        "rounding of a time; "
        "more time.micro_steps or a smaller time.sync_every (now {}) keep overlaps smaller\n",
        scene.name, speed / scene.radius, blur / scene.radius, scene.sync_every);
}

std::string warning_of_small_domains(const SceneParameters& scene, int n_ranks, int n_threads) {
    // No warning below 8 ranks, because such runs are tests or use small machines.
    constexpr int few_ranks = 8;
    const double most_ranks = most_ranks_of(scene);
    if (scene.method != Method::event_driven || n_ranks < few_ranks || n_ranks <= most_ranks)
        return "";
    const int n_cores = n_ranks * n_threads;
    const int threads = threads_that_fill(n_cores,
                                          static_cast<int>(std::ceil(n_cores / most_ranks)));
    return fmt::format("{} ranks cut {} discs into small domains, so more than half of the work is "
                       "done twice; try: {} rank{} with --threads {}",
                       n_ranks, scene.n_discs, n_cores / threads, n_cores == threads ? "" : "s",
                       threads);
}

void warn_of_close_pairs(const SceneParameters& scene, const Totals& start,
                         const Messages& messages) {
    const auto pairs = [](std::uint64_t count) {
        return count == 1 ? std::string("1 pair") : fmt::format("{} pairs", count);
    };
    if (start.overlapping_pairs > 0)
        messages.warn("{}: warning: {} of discs overlap at the start; they pass through each other "
                      "and collide once they have come apart\n",
                      scene.name, pairs(start.overlapping_pairs));
    if (start.chained_discs > 0)
        messages.warn("{}: warning: {} two others or more at the start; what a hit does to discs "
                      "that touch mechanics does not define: "
                      "here the order of ids does\n",
                      scene.name,
                      start.chained_discs == 1
                          ? "1 disc touches"
                          : fmt::format("{} discs touch", start.chained_discs));
    if (start.sliding_pairs > 0)
        messages.warn("{}: warning: {} of discs that touch slide along each other at the start; "
                      "whether they collide the last digits decide\n",
                      scene.name, pairs(start.sliding_pairs));
}

} // namespace carrom
