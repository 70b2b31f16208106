// SPDX-License-Identifier: BSD-3-Clause
#include "apps/accuracy/accuracy_table.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>

#include "apps/shell/words.hpp"
#include "core/box_text.hpp"
#include "machine/machine.hpp"
#include "run/files/csv_table.hpp"

namespace carrom {

namespace {

constexpr std::string_view setting_columns = "scene,box_size,radius,n_discs,packing,sync_every,"
                                             "start,start_hash,method,micro_steps,precision,"
                                             "arithmetic,contraction";
constexpr std::string_view number_columns =
    "pair_collisions,wall_collisions,collision_frequency,collision_frequency_error,wall_pressure,"
    "wall_pressure_error,virial_pressure,virial_pressure_error,kinetic_energy,rejected_candidates,"
    "overlapping_pairs_per_disc,deepest_overlap,distance_rms,distance_median,core_seconds";
constexpr std::string_view build_columns = "version,compiler,flags,machine";

std::string setting_fields(const SceneParameters& scene, const TrialStart& start,
                           const TrialKey& key) {
    const RunSetting& s = key.setting;
    return fmt::format(
        "{},{},{},{},{:.6g},{},{},{},{},{},{},{},{}",
        plain_field(std::filesystem::path(scene.name).filename().string()), scene.box, scene.radius,
        scene.n_discs, scene.packing(), scene.sync_every, key.start, to_string(start.hash),
        name_of(s.method), s.micro_steps, s.precision == Precision::single ? "single" : "double",
        s.arithmetic == Arithmetic::naive ? "naive" : "stable", s.contraction ? "on" : "off");
}

std::string build_fields() {
    const BuildFacts build = build_facts();
    return fmt::format("{},{},{},{}", version(), plain_field(build.compiler),
                       plain_field(build.flags), plain_field(processor_name()));
}

std::string number_fields(const TrialOutcome& outcome) {
    const Trial& trial = outcome.trial;
    const Averages& a = trial.averages;
    return fmt::format(
        "{},{},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{},{:.10g},"
        "{:.10g},{:.10g},{:.10g},{:.10g}",
        trial.totals.pair_collisions, trial.totals.wall_collisions, a.collision_frequency.value,
        a.collision_frequency.error, a.wall_pressure.value, a.wall_pressure.error,
        a.virial_pressure.value, a.virial_pressure.error, trial.totals.kinetic_energy,
        trial.totals.rejected_candidates, trial.overlapping_pairs_per_disc, trial.deepest_overlap,
        outcome.distance.root_mean_square, outcome.distance.median, trial.core_seconds);
}

} // namespace

std::string costs_header() {
    return fmt::format("{},steps,early_step,repetition,{},threads,failure,{}", setting_columns,
                       number_columns, build_columns);
}

std::string costs_line(const SceneParameters& scene, const TrialStart& start, const TrialKey& key,
                       const TrialOutcome& outcome, int threads) {
    const std::string without_numbers(
        static_cast<std::size_t>(std::ranges::count(number_columns, ',')), ',');
    return fmt::format("{},{},{},{},{},{},{},{}", setting_fields(scene, start, key),
                       key.length.steps, key.length.early_step, key.repetition,
                       outcome.failure.empty() ? number_fields(outcome) : without_numbers, threads,
                       plain_field(outcome.failure), build_fields());
}

std::string distances_header() {
    return fmt::format("{},step,collisions_per_disc,distance_rms,distance_median,{}",
                       setting_columns, build_columns);
}

std::string distances_line(const SceneParameters& scene, const TrialStart& start,
                           const TrialKey& key, std::int64_t step, double collisions,
                           const Distance& distance) {
    return fmt::format("{},{},{:.6g},{:.6g},{:.6g},{}", setting_fields(scene, start, key), step,
                       collisions, distance.root_mean_square, distance.median, build_fields());
}

} // namespace carrom
