// SPDX-License-Identifier: BSD-3-Clause
#include "apps/accuracy_table.hpp"

#include <filesystem>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/words.hpp"
#include "machine/machine.hpp"

namespace carrom {

namespace {

constexpr std::string_view setting_columns = "scene,box_size,radius,n_discs,packing,sync_every,"
                                             "start,start_hash,method,micro_steps,precision,"
                                             "arithmetic,contraction";
constexpr std::string_view number_columns =
    "pair_collisions,wall_collisions,collision_frequency,collision_frequency_error,wall_pressure,"
    "wall_pressure_error,"
    "virial_pressure,virial_pressure_error,kinetic_energy,rejected_candidates,overlapping_pairs_"
    "per_disc,deepest_overlap,"
    "distance_rms,distance_median,core_seconds";
constexpr std::size_t n_numbers = 15;
constexpr std::string_view build_columns = "version,compiler,flags,machine";

std::string trial_columns() {
    return fmt::format("{},steps,early_step,repetition", setting_columns);
}

std::string setting_fields(const Scene& scene, const TrialStart& start, const TrialKey& key) {
    const RunSetting& s = key.setting;
    return fmt::format("{},{},{},{},{:.6g},{},{},{},{},{},{},{},{}",
                       plain_field(std::filesystem::path(scene.name).filename().string()),
                       scene.box_size, scene.radius, scene.n_discs, scene.packing(),
                       scene.sync_every, key.start, to_string(start.hash), name_of(s.method),
                       s.micro_steps, s.precision == Precision::single ? "single" : "double",
                       s.arithmetic == Arithmetic::naive ? "naive" : "stable",
                       s.contraction ? "on" : "off");
}

std::string trial_fields(const Scene& scene, const TrialStart& start, const TrialKey& key) {
    return fmt::format("{},{},{},{}", setting_fields(scene, start, key), key.length.steps,
                       key.length.early_step, key.repetition);
}

std::string build_fields() {
    const BuildFacts build = build_facts();
    return fmt::format("{},{},{},{}", version(), plain_field(build.compiler),
                       plain_field(build.flags), plain_field(processor_name()));
}

} // namespace

AccuracyTable::AccuracyTable(const std::string& path)
    : table_(path, fmt::format("{},{},threads,failure,{}", trial_columns(), number_columns,
                               build_columns)) {}

void AccuracyTable::add(const Scene& scene, const TrialStart& start, const TrialKey& key,
                        const Trial& trial, const Distance& distance, int threads) {
    const Averages& a = trial.averages;
    const auto text = [](double number) { return fmt::format("{:.10g}", number); };
    append(trial_fields(scene, start, key),
           {fmt::format("{}", trial.totals.pair_collisions),
            fmt::format("{}", trial.totals.wall_collisions), text(a.collision_frequency.value),
            text(a.collision_frequency.error), text(a.wall_pressure.value),
            text(a.wall_pressure.error), text(a.virial_pressure.value),
            text(a.virial_pressure.error), text(trial.totals.kinetic_energy),
            fmt::format("{}", trial.totals.rejected_candidates),
            text(trial.overlapping_pairs_per_disc), text(trial.deepest_overlap),
            text(distance.root_mean_square), text(distance.median), text(trial.core_seconds)},
           "", threads);
}

void AccuracyTable::add_failure(const Scene& scene, const TrialStart& start, const TrialKey& key,
                                const std::string& reason, int threads) {
    append(trial_fields(scene, start, key), std::vector<std::string>(n_numbers), reason, threads);
}

void AccuracyTable::append(const std::string& key, const std::vector<std::string>& fields,
                           const std::string& failure, int threads) {
    table_.append(fmt::format("{},{},{},{},{}", key, fmt::join(fields, ","), threads,
                              plain_field(failure), build_fields()));
}

DistanceTable::DistanceTable(const std::string& path)
    : table_(path, fmt::format("{},step,collisions_per_disc,distance_rms,distance_median,{}",
                               setting_columns, build_columns)) {}

void DistanceTable::add(const Scene& scene, const TrialStart& start, const TrialKey& key,
                        std::int64_t step, double collisions, const Distance& distance) {
    table_.append(fmt::format("{},{},{:.6g},{:.6g},{:.6g},{}", setting_fields(scene, start, key),
                              step, collisions, distance.root_mean_square, distance.median,
                              build_fields()));
}

} // namespace carrom
