// SPDX-License-Identifier: BSD-3-Clause
#include "summary.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "machine.hpp"

namespace carrom {

namespace {

const char* name_of(CollisionRule rule) { return rule == CollisionRule::one ? "one" : "all"; }

double disc_steps(const RunResult& result) {
    return static_cast<double>(result.end.n_discs) * static_cast<double>(result.last_step - result.first_step);
}

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }

std::string phases_text(const RunResult& result) {
    double all = 0;
    for (const auto& [name, seconds] : result.phase_seconds) all += seconds;
    std::string text;
    for (const auto& [name, seconds] : result.phase_seconds)
        if (seconds >= 0.005 * all) // the report has the small ones too
            text += fmt::format("{}{} {:.3g} s ({:.0f} %)", text.empty() ? "" : ", ", name, seconds, 100 * ratio(seconds, all));
    return text;
}

std::string windows_text(const ReplayCounts& replays) {
    return fmt::format("{}, {:.3g} % of them redone in part; {} replays of blocks, {:.3g} % repeated", replays.windows,
                       100 * ratio(static_cast<double>(replays.windows_redone), static_cast<double>(replays.windows)),
                       replays.blocks, 100 * ratio(static_cast<double>(replays.blocks_redone), static_cast<double>(replays.blocks)));
}

std::string plural(int count, const char* what) { return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"); }

} // namespace

double ns_per_disc_step(const RunResult& result) { return ratio(1e9 * result.wall_seconds, disc_steps(result)); }

double energy_drift(const RunResult& result) {
    return ratio(result.end.kinetic_energy - result.start.kinetic_energy, result.start.kinetic_energy);
}

double collisions_per_disc(const Scene& scene, const RunResult& result) {
    const std::uint64_t taken_part = (result.end.wall_collisions - result.start.wall_collisions) +
                                     2 * (result.end.pair_collisions - result.start.pair_collisions);
    return ratio(static_cast<double>(taken_part), disc_steps(result) * static_cast<double>(scene.micro_steps));
}

std::string summary_text(const Scene& scene, const RunResult& result) {
    const auto line = [](const char* label, const std::string& text) { return fmt::format("{:<12}{}\n", label, text); };
    const std::int64_t n_steps = result.last_step - result.first_step;
    std::string text;
    text += line("scene", fmt::format("{}: {} discs of radius {:g} in a box of {:g}, packing {:.4g}", scene.name,
                                      scene.n_discs, scene.radius, scene.box_size, scene.packing()));
    text += line("rule", fmt::format("collisions = \"{}\", micro_steps = {}, sync_every = {}", name_of(scene.rule),
                                     scene.micro_steps, scene.sync_every));
    text += line("steps", fmt::format("{} in {:.4g} s: {:.4g} steps/s, {:.4g} ns per disc-step", n_steps,
                                      result.wall_seconds, ratio(static_cast<double>(n_steps), result.wall_seconds),
                                      ns_per_disc_step(result)));
    text += line("machine", fmt::format("{} x {}, {:.0f} bytes per disc at the peak", plural(result.ranks, "rank"),
                                        plural(result.threads, "thread"), result.peak_bytes_per_disc));
    text += line("phases", phases_text(result));
    text += line("collisions", fmt::format("{} with walls, {} of pairs; {:.4g} per disc and micro-step (nu dt)",
                                           result.end.wall_collisions, result.end.pair_collisions,
                                           collisions_per_disc(scene, result)));
    if (scene.rule == CollisionRule::all) text += line("windows", windows_text(result.replays));
    else text += line("rejected", fmt::format("{} candidates lost a disc to an earlier collision", result.end.rejected_candidates));
    text += line("overlapping", fmt::format("{} pairs at the end, {} at the start", result.end.overlapping_pairs,
                                            result.start.overlapping_pairs));
    text += line("energy", fmt::format("{:.17g}, changed by {:.2g} of itself", result.end.kinetic_energy, energy_drift(result)));
    text += line("momentum", fmt::format("{:.17g} {:.17g}", result.end.momentum_x, result.end.momentum_y));
    text += line("state hash", to_string(result.end.hash));
    return text;
}

std::string report_text(const Scene& scene, const RunResult& result) {
    nlohmann::ordered_json phases = nlohmann::ordered_json::object();
    for (const auto& [name, seconds] : result.phase_seconds) phases[name] = seconds;
    const nlohmann::ordered_json report = {
        {"version", version()},
        {"scene", scene.name},
        {"state_hash", to_string(result.end.hash)},
        {"n_discs", result.end.n_discs},
        {"packing", scene.packing()},
        {"rule", name_of(scene.rule)},
        {"micro_steps", scene.micro_steps},
        {"sync_every", scene.sync_every},
        {"first_step", result.first_step},
        {"steps", result.last_step - result.first_step},
        {"wall_collisions", result.end.wall_collisions},
        {"pair_collisions", result.end.pair_collisions},
        {"rejected_candidates", result.end.rejected_candidates},
        {"overlapping_pairs", result.end.overlapping_pairs},
        {"collisions_per_disc_per_micro_step", collisions_per_disc(scene, result)},
        {"kinetic_energy", result.end.kinetic_energy},
        {"energy_drift", energy_drift(result)},
        {"momentum", {result.end.momentum_x, result.end.momentum_y}},
        {"wall_seconds", result.wall_seconds},
        {"ns_per_disc_step", ns_per_disc_step(result)},
        {"ranks", result.ranks},
        {"threads", result.threads},
        {"windows", result.replays.windows},
        {"windows_redone", result.replays.windows_redone},
        {"block_replays", result.replays.blocks},
        {"block_replays_redone", result.replays.blocks_redone},
        {"phase_seconds", phases},
        {"peak_bytes_per_disc", result.peak_bytes_per_disc},
    };
    // A scene's name is whatever bytes the file system allows; replaced where they are not UTF-8.
    return report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

} // namespace carrom
