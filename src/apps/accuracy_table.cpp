// SPDX-License-Identifier: BSD-3-Clause
#include "accuracy_table.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "carrom/core/errors.hpp"
#include "data_output.hpp"
#include "machine.hpp"

namespace carrom {

namespace {

constexpr const char* key_columns = "scene,box_size,radius,n_discs,packing,sync_every,start,start_hash,rule,micro_steps,precision,"
                                    "arithmetic,contraction,steps,early_step";
constexpr const char* number_columns =
    "pair_collisions,wall_collisions,collision_frequency,collision_frequency_error,wall_pressure,wall_pressure_error,"
    "virial_pressure,virial_pressure_error,kinetic_energy,rejected_candidates,overlapping_pairs_per_disc,deepest_overlap,"
    "distance_rms,distance_median,core_seconds";
constexpr std::size_t n_numbers = 15;
constexpr const char* machine_columns = "threads,failure,version,compiler,flags,machine";

std::string header() { return fmt::format("{},{},{}\n", key_columns, number_columns, machine_columns); }

/// A text that needs no quotes in CSV.
std::string plain(std::string text) {
    std::replace_if(text.begin(), text.end(), [](char c) { return c == ',' || c == '"' || c == '\n' || c == '\r'; }, ';');
    return text;
}

std::string key_of(const Scene& scene, const TrialStart& start, const TrialKey& key) {
    const RunSetting& s = key.setting;
    return fmt::format("{},{},{},{},{:.6g},{},{},{},{},{},{},{},{},{},{}", plain(std::filesystem::path(scene.name).filename().string()), scene.box_size, scene.radius,
                       scene.n_discs, scene.packing(), scene.sync_every, key.start, to_string(start.hash),
                       s.rule == CollisionRule::one ? "one" : "all", s.micro_steps,
                       s.precision == Precision::single ? "single" : "double", s.arithmetic == Arithmetic::naive ? "naive" : "stable",
                       s.contraction ? "on" : "off", key.length.steps, key.length.early_step);
}

/// The first fields of a line, as many as a key has.
std::string key_in(const std::string& line) {
    const auto n_fields = std::count(key_columns, key_columns + std::strlen(key_columns), ',') + 1;
    std::size_t end = 0;
    for (std::ptrdiff_t k = 0; k < n_fields && end != std::string::npos; ++k) end = line.find(',', end == 0 ? 0 : end + 1);
    return line.substr(0, end);
}

[[noreturn]] void refuse(const std::string& path, const std::string& text) { throw InputError({{"--output " + path, 0, text}}); }

} // namespace

AccuracyTable::AccuracyTable(std::string path) : path_(std::move(path)) {
    if (const std::string obstacle = obstacle_to_opening(path_); !obstacle.empty()) refuse(path_, obstacle);
    std::string text;
    if (std::ifstream file(path_, std::ios::binary); file) text.assign(std::istreambuf_iterator<char>(file), {});
    const std::size_t whole = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
    std::error_code error;
    if (whole < text.size()) std::filesystem::resize_file(path_, whole, error);
    if (error) refuse(path_, error.message());
    text.resize(whole);
    if (text.empty()) {
        std::ofstream file(path_, std::ios::binary | std::ios::app);
        if (!(file << header() << std::flush)) refuse(path_, std::strerror(errno));
        return;
    }
    if (!text.starts_with(header())) refuse(path_, "is not a table of this version of carrom accuracy; name another file");
    for (std::size_t begin = header().size(); begin < text.size();) {
        const std::size_t end = text.find('\n', begin);
        keys_.insert(key_in(text.substr(begin, end - begin)));
        begin = end + 1;
    }
}

bool AccuracyTable::has(const Scene& scene, const TrialStart& start, const TrialKey& key) const {
    return keys_.contains(key_of(scene, start, key));
}

void AccuracyTable::add(const Scene& scene, const TrialStart& start, const TrialKey& key, const Trial& trial,
                        const Distance& distance, int threads) {
    const Averages& a = trial.averages;
    const auto text = [](double number) { return fmt::format("{:.10g}", number); };
    append(key_of(scene, start, key),
           {fmt::format("{}", trial.totals.pair_collisions), fmt::format("{}", trial.totals.wall_collisions),
            text(a.collision_frequency.value), text(a.collision_frequency.error), text(a.wall_pressure.value),
            text(a.wall_pressure.error), text(a.virial_pressure.value), text(a.virial_pressure.error),
            text(trial.totals.kinetic_energy), fmt::format("{}", trial.totals.rejected_candidates),
            text(trial.overlapping_pairs_per_disc), text(trial.deepest_overlap), text(distance.root_mean_square),
            text(distance.median), text(trial.core_seconds)},
           "", threads);
}

void AccuracyTable::add_failure(const Scene& scene, const TrialStart& start, const TrialKey& key, const std::string& reason,
                                int threads) {
    append(key_of(scene, start, key), std::vector<std::string>(n_numbers), reason, threads);
}

void AccuracyTable::append(const std::string& key, const std::vector<std::string>& fields, const std::string& failure,
                           int threads) {
    const BuildFacts build = build_facts();
    std::ofstream file(path_, std::ios::binary | std::ios::app);
    file << fmt::format("{},{},{},{},{},{},{},{}\n", key, fmt::join(fields, ","), threads, plain(failure), version(),
                        plain(build.compiler), plain(build.flags), plain(processor_name()))
         << std::flush;
    if (!file) refuse(path_, std::strerror(errno));
    keys_.insert(key);
}

} // namespace carrom
