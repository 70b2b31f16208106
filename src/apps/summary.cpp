// SPDX-License-Identifier: BSD-3-Clause
#include "apps/summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "machine/machine.hpp"

namespace carrom {

namespace {

const char* name_of(Method method) {
    return method == Method::time_stepped ? "time-stepped" : "event-driven";
}

double disc_steps(const RunResult& result) {
    return static_cast<double>(result.end.n_discs) *
           static_cast<double>(result.last_step - result.first_step);
}

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }

/// What leaves the default's bits, and so its promise; empty for the default.
std::string arithmetic_text(const Scene& scene) {
    std::string text;
    if (scene.precision == Precision::single) text += ", precision = \"single\"";
    if (scene.arithmetic == Arithmetic::naive)
        text += scene.contraction ? ", arithmetic = \"naive\", contraction = true"
                                  : ", arithmetic = \"naive\"";
    return text;
}

/// Pairs that a disc takes part in, on average, as with collisions.
double overlapping_pairs_per_disc(const RunResult& result) {
    return ratio(2 * static_cast<double>(result.end.overlapping_pairs),
                 static_cast<double>(result.end.n_discs));
}

std::string radii_text(const Scene& scene) {
    double least = scene.radius;
    for (const Species& one : scene.effects.species) least = std::min(least, one.radius);
    return least < scene.radius ? fmt::format("radii {:g} to {:g}", least, scene.radius)
                                : fmt::format("radius {:g}", scene.radius);
}

double deepest_overlap(const Scene& scene, const RunResult& result) {
    return ratio(result.end.deepest_overlap, 2 * scene.radius);
}

bool is_own_work(std::string_view phase) {
    static constexpr std::array others = {"wait", "exchange", "conflicts", "set-up", "output"};
    return std::find(others.begin(), others.end(), phase) == others.end();
}

std::string phases_text(const RunResult& result) {
    double all = 0;
    for (const auto& [name, seconds] : result.phase_seconds) all += seconds;
    std::string text;
    for (const auto& [name, seconds] : result.phase_seconds)
        if (seconds >= 0.005 * all) // the report has the small ones too
            text += fmt::format("{}{} {:.3g} s ({:.0f} %)", text.empty() ? "" : ", ", name, seconds,
                                100 * ratio(seconds, all));
    return text;
}

/// How even the ranks' work is, and where it is least so.
std::string imbalance_text(const RunResult& result) {
    std::string text = fmt::format("{:.3f} times the mean of the ranks' own work on the busiest",
                                   result.imbalance);
    const double enough = 0.1 *
                          busy_seconds(result.phase_seconds); // what is short is uneven by chance
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
        "{}, {:.3g} % of them redone in part; {} replays of blocks, {:.3g} % repeated",
        runs.windows,
        100 * ratio(static_cast<double>(runs.windows_redone), static_cast<double>(runs.windows)),
        runs.blocks,
        100 * ratio(static_cast<double>(runs.blocks_redone), static_cast<double>(runs.blocks)));
}

std::string estimate_text(const Estimate& estimate) {
    if (!(estimate.error >= 0)) return fmt::format("{:.5g}", estimate.value);
    return fmt::format("{:.7g} +- {:.1g}", estimate.value, estimate.error);
}

std::string collision_rate_text(const Averages& averages) {
    if (averages.collision_frequency.value == 0) return "no disc met another one";
    return fmt::format("{} with other discs per disc and step; mean free time {} steps",
                       estimate_text(averages.collision_frequency),
                       estimate_text(averages.mean_free_time));
}

std::string pressure_text(const Averages& averages) {
    return fmt::format("{} from collisions with walls, {} with those of pairs",
                       estimate_text(averages.wall_pressure),
                       estimate_text(averages.virial_pressure));
}

std::string speeds_text(const Scene& scene, const Averages& averages) {
    const auto n = static_cast<double>(scene.n_discs);
    if (scene.effects.are_any())
        return fmt::format("mean {}; kurtosis {}", estimate_text(averages.mean_speed),
                           estimate_text(averages.speed_kurtosis));
    return fmt::format("mean {}; kurtosis {}, {:.5g} in equilibrium",
                       estimate_text(averages.mean_speed), estimate_text(averages.speed_kurtosis),
                       2 * n / (n + 1));
}

/// JSON has no infinity and no NaN: null then.
nlohmann::ordered_json number_or_null(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json estimate_json(const Estimate& estimate) {
    return {{"value", number_or_null(estimate.value)}, {"error", number_or_null(estimate.error)}};
}

nlohmann::ordered_json averages_json(const Averages& averages) {
    return {{"from_step", averages.first_step},
            {"over_steps", averages.steps},
            {"blocks", averages.n_blocks},
            {"collision_frequency", estimate_json(averages.collision_frequency)},
            {"mean_free_time", estimate_json(averages.mean_free_time)},
            {"wall_pressure", estimate_json(averages.wall_pressure)},
            {"virial_pressure", estimate_json(averages.virial_pressure)},
            {"mean_speed", estimate_json(averages.mean_speed)},
            {"speed_kurtosis", estimate_json(averages.speed_kurtosis)}};
}

/// Columns of numbers; null where there is none.
nlohmann::ordered_json tables_json(const std::vector<MeasuredTable>& tables) {
    nlohmann::ordered_json all = nlohmann::ordered_json::object();
    for (const MeasuredTable& table : tables) {
        nlohmann::ordered_json columns = nlohmann::ordered_json::object();
        columns["remarks"] = table.remarks;
        for (std::size_t k = 0; k < table.columns.size(); ++k) {
            nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
            for (const std::vector<double>& row : table.rows)
                numbers.push_back(number_or_null(row[k]));
            columns[table.columns[k]] = std::move(numbers);
        }
        all[table.name] = std::move(columns);
    }
    return all;
}

std::string effects_text(const RunResult& result) {
    std::string text;
    for (const EffectCost& cost : result.effect_costs) {
        const std::string time = cost.time_ratio
                                     ? fmt::format("{:.0f} % of the time", 100 * cost.time_share)
                                     : "time not measured";
        text += fmt::format("{}{} ({}, {:g} bytes per disc)", text.empty() ? "" : "; ", cost.name,
                            time, cost.bytes_per_disc);
    }
    return text;
}

nlohmann::ordered_json effect_costs_json(const RunResult& result) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const EffectCost& cost : result.effect_costs) {
        const bool is_measured = cost.time_ratio.has_value();
        list.push_back(
            {{"effect", cost.name},
             {"time_share", is_measured ? nlohmann::ordered_json(cost.time_share) : nullptr},
             {"time_ratio", is_measured ? nlohmann::ordered_json(*cost.time_ratio) : nullptr},
             {"bytes_per_disc", cost.bytes_per_disc}});
    }
    return list;
}

std::string measured_text(const Scene& scene, const std::vector<MeasuredTable>& tables) {
    if (tables.empty())
        return fmt::format("nothing yet: the first sample is that of step {}",
                           scene.measurements->from_step);
    std::string names;
    for (const MeasuredTable& table : tables) names += (names.empty() ? "" : ", ") + table.name;
    return fmt::format("{} in {} ({})", names, scene.measurements->folder,
                       tables.front().remarks.front());
}

/// "120 of 400 discs: left 70, top 50" where a side is open.
std::string departed_text(const Scene& scene, const Totals& totals) {
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

} // namespace

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

std::string summary_text(const Scene& scene, const RunResult& result) {
    const auto line = [](const char* label, const std::string& text) {
        return fmt::format("{:<12}{}\n", label, text);
    };
    const std::int64_t n_steps = result.last_step - result.first_step;
    std::string text;
    text += line("scene",
                 fmt::format("{}: {} discs of {} in a box of {:g}, packing {:.4g}", scene.name,
                             scene.n_discs, radii_text(scene), scene.box_size, scene.packing()));
    text += line("rule", fmt::format("collisions = \"{}\", micro_steps = {}, sync_every = {}{}",
                                     name_of(scene.method), scene.micro_steps, scene.sync_every,
                                     arithmetic_text(scene)));
    if (scene.effects.are_any())
        text += line("effects", result.effect_costs.empty() ? description(scene.effects)
                                                            : effects_text(result));
    text += line("steps", fmt::format("{} in {:.4g} s: {:.4g} steps/s, {:.4g} ns per disc-step",
                                      n_steps, result.wall_seconds,
                                      ratio(static_cast<double>(n_steps), result.wall_seconds),
                                      ns_per_disc_step(result)));
    text += line("machine",
                 fmt::format("{} x {}, {:.0f} bytes per disc at the peak",
                             plural(result.ranks, "rank"), plural(result.threads, "thread"),
                             result.peak_bytes_per_disc));
    text += line("phases", phases_text(result));
    if (result.ranks > 1) text += line("imbalance", imbalance_text(result));
    text += line("collisions",
                 fmt::format("{} with walls, {} of pairs; {:.4g} per disc and micro-step (nu dt)",
                             result.end.wall_collisions, result.end.pair_collisions,
                             collisions_per_disc(scene, result)));
    if (result.averages.steps > 0) {
        if (!std::isnan(result.averages.collision_frequency.value))
            text += line("frequency", collision_rate_text(result.averages));
        if (!scene.effects.are_any()) text += line("pressure", pressure_text(result.averages));
        text += line("speeds", speeds_text(scene, result.averages));
    }
    if (scene.method == Method::event_driven)
        text += line("windows", windows_text(result.runs));
    else
        text += line(
            "rejected",
            fmt::format("{} candidates lost a disc to an earlier collision, {:.3g} % of all",
                        result.end.rejected_candidates, 100 * rejected_share(result)));
    text += line(
        "overlapping",
        fmt::format(
            "{} pairs at the end, {:.3g} per disc, by up to {:.2g} diameters; {} at the start",
            result.end.overlapping_pairs, overlapping_pairs_per_disc(result),
            deepest_overlap(scene, result), result.start.overlapping_pairs));
    if (const std::string departed = departed_text(scene, result.end); !departed.empty())
        text += line("gone", departed);
    std::string others;
    if (scene.effects.contact.kind == ContactKind::rough)
        others += fmt::format(", {:.17g} of spin", result.end.rotational_energy);
    if (scene.effects.gravity.is_any())
        others += fmt::format(", {:.17g} of height", result.end.potential_energy);
    const std::string what = others.empty() ? "," : " of motion" + others + "; the sum has";
    text += line("energy", fmt::format("{:.17g}{} changed by {:.4g} of itself",
                                       result.end.kinetic_energy, what, energy_drift(result)));
    if (scene.measurements) text += line("measured", measured_text(scene, result.tables));
    text += line("momentum",
                 fmt::format("{:.17g} {:.17g}", result.end.momentum_x, result.end.momentum_y));
    text += line("state hash", to_string(result.end.hash));
    return text;
}

std::string report_text(const Scene& scene, const RunResult& result) {
    nlohmann::ordered_json phases = nlohmann::ordered_json::object();
    for (const auto& [name, seconds] : result.phase_seconds) phases[name] = seconds;
    nlohmann::ordered_json phase_imbalance = nlohmann::ordered_json::object();
    for (const auto& [name, imbalance] : result.phase_imbalance) phase_imbalance[name] = imbalance;
    nlohmann::ordered_json report = {
        {"version", version()},
        {"scene", scene.name},
        {"state_hash", to_string(result.end.hash)},
        {"n_discs", result.end.n_discs},
        {"gone", result.end.departed},
        {"packing", scene.packing()},
        {"rule", name_of(scene.method)},
        {"micro_steps", scene.micro_steps},
        {"precision", scene.precision == Precision::single ? "single" : "double"},
        {"arithmetic", scene.arithmetic == Arithmetic::naive ? "naive" : "stable"},
        {"contraction", scene.contraction},
        {"sync_every", scene.sync_every},
        {"first_step", result.first_step},
        {"steps", result.last_step - result.first_step},
        {"wall_collisions", result.end.wall_collisions},
        {"pair_collisions", result.end.pair_collisions},
        {"rejected_candidates", result.end.rejected_candidates},
        {"rejected_share", rejected_share(result)},
        {"overlapping_pairs", result.end.overlapping_pairs},
        {"overlapping_pairs_per_disc", overlapping_pairs_per_disc(result)},
        {"deepest_overlap", deepest_overlap(scene, result)},
        {"collisions_per_disc_per_micro_step", collisions_per_disc(scene, result)},
        {"averages", averages_json(result.averages)},
        {"kinetic_energy", result.end.kinetic_energy},
        {"energy_drift", energy_drift(result)},
        {"momentum", {result.end.momentum_x, result.end.momentum_y}},
        {"wall_seconds", result.wall_seconds},
        {"ns_per_disc_step", ns_per_disc_step(result)},
        {"ranks", result.ranks},
        {"threads", result.threads},
        {"windows", result.runs.windows},
        {"windows_redone", result.runs.windows_redone},
        {"block_replays", result.runs.blocks},
        {"block_replays_redone", result.runs.blocks_redone},
        {"phase_seconds", phases},
        {"phase_imbalance", phase_imbalance},
        {"imbalance", result.imbalance},
        {"peak_bytes_per_disc", result.peak_bytes_per_disc},
    };
    if (scene.effects.contact.kind == ContactKind::rough)
        report["rotational_energy"] = result.end.rotational_energy;
    if (scene.effects.gravity.is_any()) report["potential_energy"] = result.end.potential_energy;
    if (scene.measurements) report["measurements"] = tables_json(result.tables);
    if (scene.effects.are_any()) report["effects"] = description(scene.effects);
    if (scene.effects.are_any()) report["effect_costs"] = effect_costs_json(result);
    // A scene's name is whatever bytes the file system allows; replaced where they are not UTF-8.
    return report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

} // namespace carrom
