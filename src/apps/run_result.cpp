// SPDX-License-Identifier: BSD-3-Clause
#include "apps/run_result.hpp"

#include <algorithm>
#include <array>

#include "core/errors.hpp"
#include "machine/machine.hpp"

namespace carrom {

namespace {

double disc_steps(const RunResult& result) {
    return static_cast<double>(result.end.n_discs) *
           static_cast<double>(result.last_step - result.first_step);
}

/// The largest of the ranks' times over their mean; 1 where there is none. **Collective.**
double imbalance_of(double seconds, const Communicator& ranks) {
    const auto nanoseconds = static_cast<std::uint64_t>(
        1e9 * seconds); // whole numbers: ranks add them in any order
    const auto sum = static_cast<double>(ranks.sum(nanoseconds));
    return sum > 0 ? static_cast<double>(ranks.max(nanoseconds)) * ranks.size() / sum : 1;
}

} // namespace

void fill_end(RunResult& result, const Simulation& simulation) {
    result.last_step = simulation.step();
    result.end = simulation.totals();
    result.averages = simulation.averages();
    result.runs = simulation.rollback_counts();
}

void fill_times(RunResult& result, const PhaseSeconds& mine, const Communicator& ranks) {
    ensure(ranks.min(std::uint64_t{mine.size()}) == mine.size(), "ranks have different phases");
    result.wall_seconds = ranks.max(result.wall_seconds);
    for (const auto& [name, seconds] : mine) {
        result.phase_seconds.emplace_back(name, ranks.max(seconds));
        result.phase_imbalance.emplace_back(name, imbalance_of(seconds, ranks));
    }
    result.imbalance = imbalance_of(busy_seconds(mine), ranks);
    result.ranks = ranks.size();
    result.threads = static_cast<int>(ranks.max(std::int64_t{result.threads}));
    const std::uint64_t bytes = ranks.sum(peak_resident_bytes());
    result.peak_bytes_per_disc = static_cast<double>(bytes) /
                                 static_cast<double>(result.end.n_discs);
}

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }

bool is_own_work(std::string_view phase) {
    static constexpr std::array others = {"wait", "exchange", "conflicts", "set-up", "output"};
    return std::find(others.begin(), others.end(), phase) == others.end();
}

double overlapping_pairs_per_disc(const RunResult& result) {
    return ratio(2 * static_cast<double>(result.end.overlapping_pairs),
                 static_cast<double>(result.end.n_discs));
}

double deepest_overlap(const Scene& scene, const RunResult& result) {
    return ratio(result.end.deepest_overlap, 2 * scene.radius);
}

double ns_per_disc_step(const RunResult& result) {
    return ratio(1e9 * result.wall_seconds, disc_steps(result));
}

double busy_seconds(const PhaseSeconds& phases) {
    double busy = 0;
    for (const auto& [name, seconds] : phases) busy += is_own_work(name) ? seconds : 0;
    return busy;
}

double energy_drift(const RunResult& result) {
    const auto all = [](const Totals& totals) {
        return totals.kinetic_energy + totals.rotational_energy + totals.potential_energy;
    };
    return ratio(all(result.end) - all(result.start), all(result.start));
}

double collisions_per_disc(const Scene& scene, const RunResult& result) {
    const std::uint64_t taken_part = (result.end.wall_collisions - result.start.wall_collisions) +
                                     2 * (result.end.pair_collisions -
                                          result.start.pair_collisions);
    return ratio(static_cast<double>(taken_part),
                 disc_steps(result) * static_cast<double>(scene.micro_steps));
}

double rejected_share(const RunResult& result) {
    const auto kept = static_cast<double>(
        (result.end.wall_collisions - result.start.wall_collisions) +
        (result.end.pair_collisions - result.start.pair_collisions));
    const auto rejected = static_cast<double>(result.end.rejected_candidates);
    return ratio(rejected, kept + rejected);
}

} // namespace carrom
