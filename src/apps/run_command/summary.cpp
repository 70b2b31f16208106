// SPDX-License-Identifier: BSD-3-Clause
#include "apps/run_command/summary.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "apps/shell/words.hpp"
#include "core/box_text.hpp"
#include "machine/machine.hpp"
#include "scene/effects/effect.hpp"

namespace carrom {

namespace {

/// Arithmetic options that differ from the default and change the bits of results; may be empty.
std::string arithmetic_text(const SceneParameters& scene) {
    std::string text;
    if (scene.precision == Precision::single) text += ", precision = \"single\"";
    if (scene.arithmetic == Arithmetic::naive)
        text += scene.contraction ? ", arithmetic = \"naive\", contraction = true"
                                  : ", arithmetic = \"naive\"";
    return text;
}

std::string radii_text(const SceneParameters& scene) {
    if (scene.are_points) return "radius 0, points";
    double least = scene.radius;
    for (const Species& one : scene.effects.species) least = std::min(least, one.radius);
    return least < scene.radius ? fmt::format("radii {:g} to {:g}", least, scene.radius)
                                : fmt::format("radius {:g}", scene.radius);
}

std::string phases_text(const RunResult& result) {
    double all = 0;
    for (const auto& [name, seconds] : result.phase_seconds) all += seconds;
    std::string text;
    for (const auto& [name, seconds] : result.phase_seconds)
        if (seconds >= 0.005 * all) // short phases are only in the report
            text += fmt::format("{}{} {:.3g} s ({:.0f} %)", text.empty() ? "" : ", ", name, seconds,
                                100 * ratio(seconds, all));
    return text;
}

/// The imbalance of the ranks' work, and the phase with the largest imbalance.
std::string imbalance_text(const RunResult& result) {
    std::string text = fmt::format("{:.3f} times the mean of the ranks' own work on the busiest",
                                   result.imbalance);
    const double enough = 0.1 * busy_seconds(result.phase_seconds); // shorter phases are uneven by
                                                                    // chance, so they are omitted
    double most = 0;
    std::string uneven;
    for (std::size_t k = 0; k < result.phase_imbalance.size(); ++k) {
        const auto& [name, imbalance] = result.phase_imbalance[k];
        if (!is_own_work(name) || result.phase_seconds[k].second < enough || imbalance <= most)
            continue;
        most = imbalance;
        uneven = name;
    }
    return uneven.empty() ? text : text + fmt::format("; {} is least even, {:.3f}", uneven, most);
}

std::string windows_text(const RollbackCounts& runs) {
    return fmt::format(
        "{}, {:.3g} % of them redone in part; {} runs of blocks, {:.3g} % repeated", runs.windows,
        100 * ratio(static_cast<double>(runs.windows_redone), static_cast<double>(runs.windows)),
        runs.blocks,
        100 * ratio(static_cast<double>(runs.blocks_redone), static_cast<double>(runs.blocks)));
}

std::string estimate_text(const Estimate& estimate) {
    if (std::isnan(estimate.value)) return "undefined";
    if (estimate.is_conserved) return fmt::format("{:.7g} (conserved)", estimate.value);
    const bool has_ends = std::isfinite(estimate.first) && std::isfinite(estimate.last);
    // They are NaN if the first or the last block has no collision, or no disc.
    if (estimate.is_changing && !has_ends)
        return fmt::format("{:.5g} (still changing)", estimate.value);
    if (estimate.is_changing)
        return fmt::format("{:.5g} (from {:.5g} to {:.5g})", estimate.value, estimate.first,
                           estimate.last);
    if (!(estimate.error >= 0)) return fmt::format("{:.5g}", estimate.value);
    return fmt::format("{:.7g} +- {:.1g}", estimate.value, estimate.error);
}

std::string collision_rate_text(const Averages& averages) {
    if (averages.collision_frequency.value == 0) return "no disc met another one";
    return fmt::format("{} with other discs per disc and step; mean free time {} steps",
                       estimate_text(averages.collision_frequency),
                       estimate_text(averages.mean_free_time));
}

std::string tensor_text(const TensorEstimate& tensor) {
    return fmt::format("pressure xx {}, xy {}, yy {}", estimate_text(tensor.xx),
                       estimate_text(tensor.xy), estimate_text(tensor.yy));
}

std::string state_text(const SceneParameters& scene, const Averages& averages) {
    std::string pressure = fmt::format("P = {}", estimate_text(averages.pressure));
    const std::string reason = reason_without_z(scene.effects);
    if (!reason.empty()) return fmt::format("{}; {}", pressure, reason);
    if (std::isnan(averages.compressibility.value)) return pressure;
    return fmt::format("{}, Z = P A / (N kT) = {}", pressure,
                       estimate_text(averages.compressibility));
}

std::string counted_pressure_text(const Averages& averages) {
    return fmt::format("{} from collisions with walls, {} with those of pairs",
                       estimate_text(averages.wall_pressure),
                       estimate_text(averages.virial_pressure));
}

std::string speeds_text(const SceneParameters& scene, const Averages& averages) {
    const auto n = static_cast<double>(scene.n_discs);
    if (scene.effects.are_any())
        return fmt::format("mean {}; kurtosis {}", estimate_text(averages.mean_speed),
                           estimate_text(averages.speed_kurtosis));
    return fmt::format("mean {}; kurtosis {}, {:.5g} in equilibrium",
                       estimate_text(averages.mean_speed), estimate_text(averages.speed_kurtosis),
                       2 * n / (n + 1));
}

std::string measured_text(const SceneParameters& scene, const std::vector<MeasuredTable>& tables) {
    if (tables.empty())
        return fmt::format("nothing yet: the first sample is that of step {}",
                           scene.measurements->from_step);
    std::string names;
    for (const MeasuredTable& table : tables) names += (names.empty() ? "" : ", ") + table.name;
    return fmt::format("{} in {} ({})", names, scene.measurements->folder,
                       tables.front().remarks.front());
}

/// How many discs departed, such as "120 of 400 discs: left 70, top 50"; empty if no side is open.
std::string departed_text(const SceneParameters& scene, const Totals& totals) {
    std::uint64_t all = 0;
    std::string boundaries;
    for (std::size_t side = 0; side < boundary_names.size(); ++side) {
        if (scene.effects.boundaries[side].kind != BoundaryKind::open) continue;
        all += totals.departed[side];
        boundaries += fmt::format("{}{} {}", boundaries.empty() ? "" : ", ", boundary_names[side],
                                  totals.departed[side]);
    }
    return boundaries.empty() ? boundaries
                              : fmt::format("{} of {} discs: {}", all, totals.n_discs, boundaries);
}

std::string plural(int count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string scene_lines(const SceneParameters& scene, const RunResult& result) {
    const std::string grown = scene.last_packing() == scene.packing() && result.size == 1
                                  ? ""
                                  : fmt::format(", {:.4g} at the last step",
                                                last_packing(scene, result));
    std::string text = labelled_line(
        "scene", fmt::format("{}: {} discs of {} in a box of {:g}, packing {:.4g}{}", scene.name,
                             scene.n_discs, radii_text(scene), scene.box, scene.packing(), grown));
    text += labelled_line("method", fmt::format("{}, micro_steps = {}, sync_every = {}{}",
                                                name_of(scene.method), scene.micro_steps,
                                                scene.sync_every, arithmetic_text(scene)));
    if (scene.effects.are_any()) text += labelled_line("effects", summary_of(scene.effects));
    return text;
}

std::string time_lines(const RunResult& result, std::int64_t last_step) {
    const std::int64_t n_steps = result.last_step - result.first_step;
    std::string text = labelled_line(
        "steps",
        fmt::format("{} in {:.4g} s: {:.4g} steps/s, {:.4g} ns per disc-step", n_steps,
                    result.wall_seconds, ratio(static_cast<double>(n_steps), result.wall_seconds),
                    ns_per_disc_step(result)));
    if (const auto& reason = result.stop_reason)
        text += labelled_line("ended", fmt::format("at step {} of {} by {}", reason->step,
                                                   last_step, text_of(*reason)));
    const std::string across = result.ranks_across == 1
                                   ? ""
                                   : fmt::format(" (up to {} share a strip)", result.ranks_across);
    const std::string device = result.device.name.empty()
                                   ? ""
                                   : fmt::format(", {} with {:.3g} GB", result.device.name,
                                                 1e-9 * static_cast<double>(result.device.bytes));
    text += labelled_line("machine", fmt::format("{}{} x {}{}, {:.0f} bytes per disc at the peak",
                                                 plural(result.ranks, "rank"), across,
                                                 plural(result.threads, "thread"), device,
                                                 result.peak_bytes_per_disc));
    text += labelled_line("phases", phases_text(result));
    if (result.ranks > 1) text += labelled_line("imbalance", imbalance_text(result));
    return text;
}

/// Text such as "energy = 0.207 +- 0.02" for each watched number.
std::string watched_text(const std::vector<WatchedNumber>& watched) {
    std::string text;
    for (const WatchedNumber& one : watched) {
        Estimate estimate{one.mean.value, one.mean.error};
        estimate.is_conserved = one.mean.is_constant;
        estimate.is_changing = one.mean.is_changing;
        estimate.first = one.quarters.front(), estimate.last = one.quarters.back();
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", one.name,
                            estimate_text(estimate));
    }
    return text;
}

std::string average_lines(const SceneParameters& scene, const RunResult& result) {
    const Averages& averages = result.averages;
    std::string text;
    if (averages.steps == 0) return text;
    if (!std::isnan(averages.collision_frequency.value))
        text += labelled_line("frequency", collision_rate_text(averages));
    const std::string undefined = reason_without_temperature(scene.effects, scene.n_discs);
    text += labelled_line("temperature",
                          undefined.empty()
                              ? fmt::format("kT = {}", estimate_text(averages.temperature))
                              : undefined);
    if (undefined.empty()) text += labelled_line("state", state_text(scene, averages));
    const TensorEstimate& tensor = averages.pressure_tensor;
    if (!std::isnan(tensor.xx.value) || !std::isnan(tensor.yy.value))
        text += labelled_line("tensor", tensor_text(tensor));
    if (!scene.effects.are_any() && scene.n_discs > 1)
        text += labelled_line("pressure", counted_pressure_text(averages));
    text += labelled_line("speeds", speeds_text(scene, averages));
    if (!result.watched.empty()) text += labelled_line("watched", watched_text(result.watched));
    const std::string doubts = doubts_of_run(result);
    return doubts.empty() ? text : text + labelled_line("errors", doubts);
}

/// The line on guarded collisions; empty if collisions take no energy.
std::string guarded_line(const RunResult& result) {
    if (result.end.energy_taken == 0 && result.end.energy_spared == 0) return {};
    return labelled_line("guarded",
                         fmt::format("{} collisions took no energy so soon after another "
                                     "one, {:.2g} % of what restitution should take",
                                     result.end.guarded_collisions, 100 * guarded_share(result)));
}

/// The line on rejected candidates in the time-stepped method, or the lines on guarded collisions
/// and repeated windows in the event-driven method.
std::string method_line(const SceneParameters& scene, const RunResult& result) {
    if (scene.method == Method::event_driven)
        return guarded_line(result) + labelled_line("windows", windows_text(result.runs));
    return labelled_line(
        "rejected",
        fmt::format("{} candidates lost a disc to an earlier collision, {:.3g} % of all",
                    result.end.rejected_candidates, 100 * rejected_share(result)));
}

std::string collision_lines(const SceneParameters& scene, const RunResult& result) {
    const Totals& end = result.end;
    std::string text = labelled_line(
        "collisions",
        fmt::format("{} with walls, {} of pairs; {:.4g} per disc and micro-step "
                    "(nu dt)",
                    end.wall_collisions, end.pair_collisions, collisions_per_disc(scene, result)));
    text += average_lines(scene, result) + method_line(scene, result);
    text += labelled_line(
        "overlapping",
        fmt::format("{} pairs at the end, {:.3g} per disc, by up to {:.2g} diameters; {} at the "
                    "start",
                    end.overlapping_pairs, overlapping_pairs_per_disc(result),
                    deepest_overlap(scene, result), result.start.overlapping_pairs));
    for (const EndNumber& number : result.end_numbers)
        text += labelled_line(number.label, fmt::format("{} {}", number.value, number.words));
    if (const std::string departed = departed_text(scene, end); !departed.empty())
        text += labelled_line("departed", departed);
    return text;
}

std::string energy_text(const SceneParameters& scene, const RunResult& result) {
    std::string others;
    for (const OtherEnergy& energy : other_energies_of(scene.effects))
        others += fmt::format(", {:.17g} {}", result.end.*energy.value, energy.words);
    const std::string what = others.empty() ? "," : " of motion" + others + "; the sum has";
    if (std::isnan(energy_drift(result)))
        return fmt::format("{:.17g}{} changed from 0", result.end.kinetic_energy, what);
    return fmt::format("{:.17g}{} changed by {:.4g} of itself", result.end.kinetic_energy, what,
                       energy_drift(result));
}

} // namespace

std::string summary_text(const SceneParameters& scene, const RunResult& result) {
    const Totals& end = result.end;
    std::string text = scene_lines(scene, result) + time_lines(result, scene.steps) +
                       collision_lines(scene, result);
    text += labelled_line("energy", energy_text(scene, result));
    if (scene.measurements) text += labelled_line("measured", measured_text(scene, result.tables));
    text += labelled_line("momentum",
                          fmt::format("{:.17g} {:.17g}", end.momentum_x, end.momentum_y));
    return text + labelled_line("state hash", to_string(end.hash));
}

} // namespace carrom
