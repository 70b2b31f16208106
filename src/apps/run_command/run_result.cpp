// SPDX-License-Identifier: BSD-3-Clause
#include "apps/run_command/run_result.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/errors.hpp"
#include "engine/engine.hpp"
#include "machine/machine.hpp"
#include "statistics/blocking.hpp"

namespace carrom {

namespace {

double disc_steps(const RunResult& result) {
    return static_cast<double>(result.end.n_discs) *
           static_cast<double>(result.last_step - result.first_step);
}

/// The largest of the ranks' times divided by their mean; 1 if all times are 0. **Collective.**
double imbalance_of(double seconds, const Communicator& ranks) {
    const auto nanoseconds = static_cast<std::uint64_t>(
        1e9 * seconds); // integers, because their sum does not depend on the order of the ranks
    const auto sum = static_cast<double>(ranks.sum(nanoseconds));
    return sum > 0 ? static_cast<double>(ranks.max(nanoseconds)) * ranks.size() / sum : 1;
}

} // namespace

void fill_end(RunResult& result, const Run& run) {
    const DiscSystem& system = run.system();
    result.last_step = system.step();
    result.stop_reason = run.stop_reason();
    result.end = system.totals();
    result.size = system.engine().size();
    result.end_numbers = end_numbers_of(run.scene(), system.engine().kept_by_effects());
    result.averages = run.sampler().averages();
    if (!reason_without_z(run.scene().effects).empty())
        result.averages.compressibility = {.value = std::numeric_limits<double>::quiet_NaN()};
    result.watched = run.watch().watched();
    result.tables = run.sampler().tables();
    result.doubts_of_tables = run.sampler().doubts();
    result.runs = system.engine().rollback_counts();
    if (result.runs.simultaneous > 0)
        result.end_numbers.push_back(
            {"simultaneous_collisions", "at one time",
             "collisions of pairs with an earlier one of the same disc: ids or roundings decide "
             "their order",
             result.runs.simultaneous});
    result.device = system.engine().device();
    result.ranks_across = system.engine().most_ranks_across();
}

double last_packing(const SceneParameters& scene, const RunResult& result) {
    if (result.size != 1) return scene.packing() * (result.size * result.size);
    if (!result.stop_reason) return scene.last_packing();
    const double size = scene.effects.size_at(static_cast<double>(result.last_step));
    return scene.packing() * (size * size);
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

double deepest_overlap(const SceneParameters& scene, const RunResult& result) {
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
    const bool began_at_rest = result.start.energy() == 0 && result.end.energy() != 0;
    if (began_at_rest) return std::numeric_limits<double>::quiet_NaN();
    return ratio(result.end.energy() - result.start.energy(), result.start.energy());
}

double collisions_per_disc(const SceneParameters& scene, const RunResult& result) {
    const std::uint64_t taken_part = (result.end.wall_collisions - result.start.wall_collisions) +
                                     2 * (result.end.pair_collisions -
                                          result.start.pair_collisions);
    return ratio(static_cast<double>(taken_part),
                 disc_steps(result) * static_cast<double>(scene.micro_steps));
}

namespace {

/// With this number of independent samples the errors are a fifth too small on average
/// (statistics/blocking.hpp).
constexpr int fewest_independent_samples = 8;

/// A text that lists the watched numbers which still change or have few independent samples, and
/// warns that errors of other averages may be too small; empty if there are no such numbers.
std::string changes_of(std::span<const WatchedNumber> watched) {
    std::vector<std::string> all;
    for (const WatchedNumber& one : watched) {
        const std::string quarters = std::isnan(one.quarters.front())
                                         ? ""
                                         : fmt::format(" ({:.3g} by quarters of the run)",
                                                       fmt::join(one.quarters, ", "));
        if (one.mean.is_changing)
            all.push_back(fmt::format("{} is still changing{}", one.name, quarters));
        else if (std::isnan(one.mean.independent_samples))
            all.push_back(
                fmt::format("{} has too few samples to show whether it changes", one.name));
        else if (one.mean.independent_samples < fewest_independent_samples)
            all.push_back(fmt::format("{} has only {:.1f} independent samples{}", one.name,
                                      one.mean.independent_samples, quarters));
    }
    if (all.empty()) return {};
    return fmt::format("{}, so the errors of other averages may be far too small; try: a longer "
                       "run from a later output.averages_from_step, and carrom replicas",
                       fmt::join(all, ", "));
}

} // namespace

std::string doubts_of_averages(const Averages& averages, std::span<const WatchedNumber> watched) {
    if (averages.pressure.is_short)
        return "none: " + reason_without_error(averages.pressure, averages);
    if (averages.steps == 0 || averages.n_blocks < static_cast<std::int64_t>(fewest_blocks))
        return "none: " + reason_without_error({averages.temperature.value}, averages);
    std::vector<std::string_view> changing, uncertain;
    std::size_t n_errors = 0;
    for (const auto& [name, estimate] : averages.named()) {
        n_errors += std::isfinite(estimate.error);
        if (estimate.is_changing) changing.push_back(name);
        if (estimate.independent_samples < fewest_independent_samples) uncertain.push_back(name);
    }
    std::string text;
    if (!changing.empty())
        text = fmt::format("{} {} still changing, so without an error", fmt::join(changing, ", "),
                           changing.size() == 1 ? "is" : "are");
    if (!uncertain.empty())
        text += fmt::format(
            "{}uncertain themselves{}, with less than {} independent samples",
            text.empty() ? "" : "; ",
            uncertain.size() == n_errors ? "" : fmt::format(" for {}", fmt::join(uncertain, ", ")),
            fewest_independent_samples);
    if (const std::string changes = changes_of(watched); !changes.empty())
        text += (text.empty() ? "" : "; ") + changes;
    return text;
}

std::string doubts_of_run(const RunResult& result) {
    std::vector<std::string> all;
    if (std::string text = doubts_of_averages(result.averages, result.watched); !text.empty())
        all.push_back(std::move(text));
    all.insert(all.end(), result.doubts_of_tables.begin(), result.doubts_of_tables.end());
    return fmt::format("{}", fmt::join(all, "; "));
}

namespace {

/// The mean number of discs that would overlap a given disc, if all discs were placed at random as
/// in an ideal gas.
double ideal_overlaps(const SceneParameters& scene) {
    const std::vector<Species> alike = {{scene.n_discs, scene.radius, 1}};
    const std::vector<Species>& species = scene.effects.species.empty() ? alike
                                                                        : scene.effects.species;
    double areas = 0;
    for (const Species& a : species)
        for (const Species& b : species)
            areas += static_cast<double>(a.count) * static_cast<double>(b.count) *
                     std::numbers::pi * std::pow(a.radius + b.radius, 2);
    return areas / (static_cast<double>(scene.n_discs) * scene.box.x * scene.box.y);
}

} // namespace

/// In the time-stepped method a lost collision lets two discs overlap. So the number of overlaps,
/// relative to an ideal gas, shows how many collisions are lost. The factors 0.8 and 3.2 are fitted
/// to lost_collisions.csv.
LostCollisions lost_collisions(const SceneParameters& scene, const RunResult& result) {
    const double ideal = ideal_overlaps(scene);
    if (scene.method != Method::time_stepped || !(ideal > 0) ||
        scene.effects.contact.kind == ContactKind::none)
        return {};
    const double overlaps = overlapping_pairs_per_disc(result) / ideal;
    LostCollisions lost;
    lost.share = std::max(1 - std::exp(-overlaps * (0.8 + 3.2 * scene.packing())),
                          rejected_share(result)); // at least the rejected candidates are lost
    const double z = result.averages.compressibility.value, kept = 1 - lost.share;
    if (kept > 0 && z > 1) {
        const double exact = 1 + (z - 1) / kept;
        lost.pressure_error = z / exact - 1;
    }
    return lost;
}

std::string warning_of_lost_collisions(const SceneParameters& scene, const RunResult& result) {
    const LostCollisions lost = lost_collisions(scene, result);
    if (!(lost.share > 0.01)) return {};
    const auto digits = [](double percent) { return percent < 9.5 ? 1 : 0; };
    const double share = 100 * lost.share, error = -100 * lost.pressure_error;
    const std::string pressure = error > 0
                                     ? fmt::format(", and the pressure is about {:.{}f} % too low",
                                                   error, digits(error))
                                     : "";
    return fmt::format(
        "the time-stepped method loses about {:.{}f} % of the collisions of pairs{}; "
        "try: time.method = \"event-driven\", or more time.micro_steps",
        share, digits(share), pressure);
}

double rejected_share(const RunResult& result) {
    const auto kept = static_cast<double>(
        (result.end.wall_collisions - result.start.wall_collisions) +
        (result.end.pair_collisions - result.start.pair_collisions));
    const auto rejected = static_cast<double>(result.end.rejected_candidates);
    return ratio(rejected, kept + rejected);
}

double guarded_share(const RunResult& result) {
    return ratio(result.end.energy_spared, result.end.energy_taken + result.end.energy_spared);
}

std::string warning_of_guarded_collisions(const SceneParameters& scene, const RunResult& result) {
    // With lasting contacts the next sync removes the energy that guarded collisions do not.
    if (scene.effects.lasting_speed > 0) return {};
    constexpr std::uint64_t fewest = 100; // with fewer of them the share is too uncertain
    const double share = guarded_share(result);
    if (!(share > 0.01) || result.end.guarded_collisions < fewest) return {};
    const bool is_named = scene.effects.contact.contact_time > 0;
    return fmt::format(
        "{} collisions took no energy, because a disc had collided within the contact time: {:.2g} "
        "% of what restitution should take; try: {}",
        result.end.guarded_collisions, 100 * share,
        is_named ? "a smaller effects.contact.contact_time, or none, so that the contact time "
                   "follows the discs"
                 : "a small effects.contact.contact_time, which costs more collisions, or "
                   "effects.lasting_contacts where discs come to rest");
}

} // namespace carrom
