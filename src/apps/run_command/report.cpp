// SPDX-License-Identifier: BSD-3-Clause
#include "apps/run_command/report.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <nlohmann/json.hpp>

#include "apps/shell/words.hpp"
#include "machine/machine.hpp"
#include "scene/effects/effect.hpp"

namespace carrom {

namespace {

/// Null stands for infinity and NaN, which JSON does not have.
nlohmann::ordered_json number_or_null(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json estimate_json(const Estimate& estimate, const Averages& averages) {
    nlohmann::ordered_json json = {
        {"value", number_or_null(estimate.value)},
        {"error", number_or_null(estimate.error)},
        {"correlation_time", number_or_null(estimate.correlation_time)},
        {"independent_samples", number_or_null(estimate.independent_samples)}};
    if (estimate.is_changing) {
        json["first"] = number_or_null(estimate.first);
        json["last"] = number_or_null(estimate.last);
    }
    const std::string reason = reason_without_error(estimate, averages);
    if (!reason.empty()) json["without_error"] = reason;
    return json;
}

nlohmann::ordered_json watched_json(const std::vector<WatchedNumber>& watched) {
    nlohmann::ordered_json all = nlohmann::ordered_json::object();
    for (const WatchedNumber& one : watched) {
        const SampledMean& mean = one.mean;
        const bool has_error = std::isfinite(mean.error) && !mean.is_changing && !mean.is_constant;
        const auto number = [=](double value) {
            return number_or_null(has_error ? value : std::numeric_limits<double>::quiet_NaN());
        };
        nlohmann::ordered_json quarters = nlohmann::ordered_json::array();
        for (const double quarter : one.quarters) quarters.push_back(number_or_null(quarter));
        all[one.name] = {{"value", number_or_null(mean.value)},
                         {"error", number(mean.error)},
                         {"correlation_time", number(mean.correlation_time)},
                         {"independent_samples", number(mean.independent_samples)},
                         {"quarters", quarters}};
        if (!has_error)
            all[one.name]["without_error"] = mean.is_constant   ? "conserved"
                                             : mean.is_changing ? "still changing: a trend is "
                                                                  "not an error"
                                                                : "too few samples";
    }
    return all;
}

nlohmann::ordered_json lost_collisions_json(const LostCollisions& lost) {
    return {{"share", lost.share}, {"pressure_error", lost.pressure_error}};
}

/// Adds the watched numbers (psi6 and energy) and the doubts about averages, if there are any.
void add_doubts(nlohmann::ordered_json& report, const RunResult& result) {
    if (!result.watched.empty()) report["watched"] = watched_json(result.watched);
    if (const std::string doubts = doubts_of_run(result); !doubts.empty())
        report["doubts"] = doubts;
}

nlohmann::ordered_json averages_json(const Averages& averages) {
    const auto estimate_json = [&averages](const Estimate& estimate) {
        return carrom::estimate_json(estimate, averages);
    };
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

/// Adds the condition that ended the run early and the GPU, if there were any.
void add_stop_and_gpu(nlohmann::ordered_json& report, const RunResult& result) {
    if (!result.device.name.empty())
        report["gpu"] = {{"name", result.device.name}, {"memory_bytes", result.device.bytes}};
    if (const auto& reason = result.stop_reason)
        report["stopped_by"] = {{"key", reason->key},
                                {"limit", reason->limit},
                                {"value", reason->value},
                                {"step", reason->step}};
}

/// Thermodynamic averages come first in the report, because most readers want these.
void add_thermodynamics(nlohmann::ordered_json& report, const SceneParameters& scene,
                        const Averages& averages) {
    const std::string no_heat = reason_without_temperature(scene.effects, scene.n_discs),
                      no_z = reason_without_z(scene.effects);
    const auto estimate = [&](const Estimate& one, const std::string& why_none) {
        nlohmann::ordered_json json = estimate_json(one, averages);
        if (std::isnan(one.value) && !why_none.empty()) json["without_value"] = why_none;
        return json;
    };
    report["radius"] = scene.are_points ? 0 : scene.radius;
    report["box"] = {scene.box.x, scene.box.y};
    if (scene.origin.is_on()) report["origin"] = {scene.origin.x, scene.origin.y};
    report["temperature"] = estimate(averages.temperature, no_heat);
    report["pressure"] = estimate(averages.pressure, no_heat);
    report["compressibility"] = estimate(averages.compressibility,
                                         no_heat.empty() ? no_z : no_heat);
    report["pressure_tensor"] = {{"xx", estimate(averages.pressure_tensor.xx, no_heat)},
                                 {"xy", estimate(averages.pressure_tensor.xy, no_heat)},
                                 {"yy", estimate(averages.pressure_tensor.yy, no_heat)}};
}

/// The tables, column by column; null stands for a missing number.
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

template <class Numbers> nlohmann::ordered_json by_name(const Numbers& numbers) {
    nlohmann::ordered_json all = nlohmann::ordered_json::object();
    for (const auto& [name, number] : numbers) all[name] = number;
    return all;
}

/// The centre-of-mass velocity of the discs in the box. It is unknown if discs have left and masses
/// differ, because the mass of the remaining discs is then unknown.
nlohmann::ordered_json drift_velocity(const SceneParameters& scene, const Totals& end) {
    const std::uint64_t n_departed = std::accumulate(end.departed.begin(), end.departed.end(),
                                                     std::uint64_t{0});
    double mass = static_cast<double>(end.n_discs - n_departed);
    if (!scene.effects.species.empty()) {
        if (n_departed > 0) return nullptr;
        mass = 0;
        for (const Species& one : scene.effects.species)
            mass += one.mass * static_cast<double>(one.count);
    }
    if (!(mass > 0)) return nullptr;
    return {end.momentum_x / mass, end.momentum_y / mass};
}

} // namespace

std::string report_text(const SceneParameters& scene, const RunResult& result) {
    nlohmann::ordered_json report = {
        {"version", version()},
        {"scene", scene.name},
        {"state_hash", to_string(result.end.hash)},
        {"n_discs", result.end.n_discs},
        {"departed", result.end.departed},
        {"packing", scene.packing()},
        {"method", name_of(scene.method)},
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
        {"guarded_collisions", result.end.guarded_collisions},
        {"guarded_share", guarded_share(result)},
        {"overlapping_pairs", result.end.overlapping_pairs},
        {"overlapping_pairs_per_disc", overlapping_pairs_per_disc(result)},
        {"deepest_overlap", deepest_overlap(scene, result)},
        {"collisions_per_disc_per_micro_step", collisions_per_disc(scene, result)},
        {"averages", averages_json(result.averages)},
        {"kinetic_energy", result.end.kinetic_energy},
        {"energy_drift", number_or_null(energy_drift(result))},
        {"momentum", {result.end.momentum_x, result.end.momentum_y}},
        {"drift_velocity", drift_velocity(scene, result.end)},
        {"wall_seconds", result.wall_seconds},
        {"ns_per_disc_step", ns_per_disc_step(result)},
        {"ranks", result.ranks},
        {"threads", result.threads},
        {"ranks_across", result.ranks_across},
        {"windows", result.runs.windows},
        {"windows_redone", result.runs.windows_redone},
        {"block_replays", result.runs.blocks},
        {"block_replays_redone", result.runs.blocks_redone},
        {"phase_seconds", by_name(result.phase_seconds)},
        {"phase_imbalance", by_name(result.phase_imbalance)},
        {"imbalance", result.imbalance},
        {"peak_bytes_per_disc", result.peak_bytes_per_disc},
    };
    add_stop_and_gpu(report, result);
    add_thermodynamics(report, scene, result.averages);
    if (scene.method == Method::time_stepped)
        report["lost_collisions"] = lost_collisions_json(lost_collisions(scene, result));
    for (const OtherEnergy& energy : other_energies_of(scene.effects))
        report[energy.name] = result.end.*energy.value;
    for (const EndNumber& number : result.end_numbers) report[number.name] = number.value;
    if (scene.last_packing() != scene.packing() || result.size != 1)
        report["last_packing"] = last_packing(scene, result);
    add_doubts(report, result);
    if (scene.measurements) report["measurements"] = tables_json(result.tables);
    if (scene.effects.are_any()) report["effects"] = summary_of(scene.effects);
    // A scene's name may have any bytes that the file system allows; invalid UTF-8 is replaced.
    return report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

} // namespace carrom
