// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/subcommands.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "apps/shell/words.hpp"
#include "core/box_text.hpp"
#include "core/computed_fields.hpp"
#include "core/side_columns.hpp"
#include "io/checkpoint.hpp"
#include "io/frame_file.hpp"
#include "parallel/agreement.hpp"
#include "run/start/restart.hpp"
#include "scene/effects/effect.hpp"
#include "scene/frozen_discs.hpp"
#include "stored_scene/stored_scene.hpp"

namespace carrom {

namespace {

const char* word_of(FileKind kind) {
    switch (kind) {
    case FileKind::checkpoint: return "checkpoint";
    case FileKind::trajectory: return "trajectory";
    case FileKind::collisions: return "collisions";
    }
    return "";
}

std::string frames_text(const std::vector<std::int64_t>& steps) {
    if (steps.empty()) return "none";
    std::string text = fmt::format("{}, of steps {} to {}", steps.size(), steps.front(),
                                   steps.back());
    const std::int64_t every = steps.size() > 1 ? steps[1] - steps[0] : 0;
    for (std::size_t k = 1; k < steps.size(); ++k)
        if (steps[k] - steps[k - 1] != every) return text + ", at several distances";
    return steps.size() > 1 ? text + fmt::format(", every {}", every) : text;
}

/// The first and last steps and times of a log, whose rows are sorted by time.
std::string span_text(const FrameFile& file) {
    const FileSummary& summary = file.summary();
    const std::uint64_t n = summary.n_rows;
    if (n == 0) return labelled_line("steps", "none");
    Rows first, last;
    file.read(0, 0, 1, first);
    file.read(0, n - 1, n, last);
    const std::size_t step = summary.place_of("step"), time = summary.place_of("time");
    return labelled_line("steps", fmt::format("{} to {}, times {:.6g} to {:.6g}", first[step][0],
                                              last[step][0], first[time][0], last[time][0]));
}

/// The names of a trajectory's fields, as scenes spell them.
std::string fields_text(const FileSummary& summary) {
    std::vector<std::string> fields;
    const auto add = [&](const char* field, const char* column) {
        if (summary.has(column)) fields.emplace_back(field);
    };
    add("position", "x");
    add("velocity", "vx");
    add("collisions", "pair_collisions");
    for (const ComputedField& field : computed_field_table) add(field.name, field.columns.front());
    add("image", "image_x");
    for (const SideColumnInfo& info : side_column_table) add(info.shown, info.shown);
    return fmt::format("{}", fmt::join(fields, " "));
}

std::string trajectory_text(const FileSummary& summary) {
    return labelled_line("fields", fields_text(summary)) +
           labelled_line("numbers", fmt::format("of {} bytes", summary.bytes_per_number)) +
           labelled_line("frames", frames_text(summary.steps));
}

/// One line for each of the first 20 species, or a single line if all discs are equal.
std::string species_text(const FileSummary& summary) {
    constexpr std::size_t most_lines = 20;
    if (summary.species.empty())
        return labelled_line("radius", fmt::format("{:g}", summary.radius));
    std::string text;
    for (std::size_t k = 0; k < std::min(most_lines, summary.species.size()); ++k) {
        const Species& one = summary.species[k];
        text += labelled_line("species", fmt::format("{}: {} discs of radius {:g} and mass {:g}", k,
                                                     one.count, one.radius, one.mass));
    }
    if (summary.species.size() > most_lines)
        text += labelled_line(
            "", fmt::format("and {} more species", summary.species.size() - most_lines));
    return text;
}

std::string summary_text(const FileSummary& summary) {
    std::string text = labelled_line("kind", word_of(summary.kind)) +
                       labelled_line("written by", "carrom " + summary.program_version);
    if (summary.kind == FileKind::collisions)
        return text + labelled_line("collisions", fmt::format("{}", summary.n_rows)) +
               labelled_line("fields", fmt::format("{}", fmt::join(summary.columns, " ")));
    text += labelled_line("discs", fmt::format("{} in a box of {:g}", summary.n_rows, summary.box));
    if (const auto& [x, y] = summary.origin; x != 0 || y != 0)
        text += labelled_line("origin", fmt::format("({:g}, {:g}) from the lower left corner; "
                                                    "positions in the file count from that corner",
                                                    x, y));
    const std::string periodic = fmt::format("{}{}", summary.is_periodic_x ? "x" : "",
                                             summary.is_periodic_y ? "y" : "");
    if (!periodic.empty()) text += labelled_line("periodic", periodic);
    text += species_text(summary);
    return summary.kind == FileKind::trajectory ? text + trajectory_text(summary) : text;
}

std::string header_text(const CheckpointHeader& header) {
    std::string text = labelled_line("step", fmt::format("{}", header.step));
    text += labelled_line("method",
                          fmt::format("{}, micro_steps = {}, sync_every = {}", header.method,
                                      header.micro_steps, header.sync_every));
    text += labelled_line(
        "collisions",
        fmt::format("{} with walls, {} of pairs", header.wall_collisions, header.pair_collisions));
    text += labelled_line("state hash", header.state_hash);
    text += labelled_line("scene", header.scene_name);
    try {
        const Effects effects = scene_of(header, {}).effects;
        if (effects.are_any()) text += labelled_line("effects", summary_of(effects));
    } catch (const InputError&) { // scenes of other versions cannot be read; print the
                                  // rest
    }
    std::string overrides;
    std::istringstream lines(header.scene_overrides);
    for (std::string line; std::getline(lines, line);)
        if (!is_of_frozen(line)) overrides += (overrides.empty() ? "" : " ") + line;
    return overrides.empty() ? text : text + labelled_line("set", overrides);
}

/// Runs `carrom info`. **Collective.**
ExitCode info(const std::string& path, const Communicator& ranks) {
    const std::optional<CheckpointHeader> header = check_damage(path, ranks);
    std::string text;
    let_root(ranks, [&] {
        const FrameFile file(path);
        const FileSummary& summary = file.summary();
        text = summary_text(summary);
        if (summary.kind == FileKind::collisions) text += span_text(file);
    });
    if (header) text += header_text(*header);
    if (ranks.is_root()) fmt::print("{}", text);
    return ExitCode::success;
}

} // namespace

Subcommand info_subcommand() {
    constexpr const char* examples = R"(Examples:
  carrom info kept/checkpoint-000000001000.h5
  carrom info trajectory.h5)";
    const auto path = std::make_shared<std::string>();
    const auto action = [path](std::vector<Problem>&) -> Action {
        return {[path](const Communicator& ranks) { return info(*path, ranks); }};
    };
    return {"info",
            "Say what is in a file",
            examples,
            {{"FILE", "", help_of_file, path.get(), true}},
            action};
}

} // namespace carrom
