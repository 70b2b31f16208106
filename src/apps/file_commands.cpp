// SPDX-License-Identifier: BSD-3-Clause
#include "apps/file_commands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "apps/data_output.hpp"
#include "apps/destinations.hpp"
#include "apps/disc_lines.hpp"
#include "apps/restart.hpp"
#include "apps/run_options.hpp"
#include "io/checkpoint.hpp"
#include "io/frame_file.hpp"
#include "parallel/agreement.hpp"
#include "stored_scene/stored_scene.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t rows_at_a_time = std::uint64_t{1} << 16;

const char* name_of(FileKind kind) {
    switch (kind) {
    case FileKind::checkpoint: return "checkpoint";
    case FileKind::trajectory: return "trajectory";
    case FileKind::collisions: return "collisions";
    }
    return "";
}

/// Lets rank 0 work alone; its InputError becomes one of all ranks. **Collective.**
void let_root(const Communicator& ranks, const std::function<void()>& work) {
    std::vector<Problem> problems;
    if (ranks.is_root()) {
        try {
            work();
        } catch (const InputError& error) {
            problems = error.problems();
        }
    }
    agree_on_problems(ranks, problems);
}

std::string line(const char* label, const std::string& text) {
    return fmt::format("{:<12}{}\n", label, text);
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

/// From when to when a log goes; it is in the order of time.
std::string span_text(const FrameFile& file) {
    const std::uint64_t n = file.summary().n_logged;
    if (n == 0) return line("steps", "none");
    std::vector<LoggedCollision> first, last;
    file.read(0, 1, first);
    file.read(n - 1, n, last);
    return line("steps", fmt::format("{} to {}, times {:.6g} to {:.6g}", first[0].step,
                                     last[0].step, first[0].time, last[0].time));
}

std::string summary_text(const FileSummary& summary) {
    std::string text = line("kind", name_of(summary.kind)) +
                       line("written by", "carrom " + summary.program_version);
    if (summary.kind == FileKind::collisions)
        return text + line("collisions", fmt::format("{}", summary.n_logged)) +
               line("fields", "step time p q impulse");
    text += line("discs", fmt::format("{} in a box of {:g}", summary.n_discs, summary.box_size));
    if (summary.kind == FileKind::trajectory) {
        text += line("radius", fmt::format("{:g}", summary.radius));
        const std::string fields = fmt::format(
            "{}{}{}{}", summary.has_position ? " position" : "",
            summary.has_velocity ? " velocity" : "", summary.has_collisions ? " collisions" : "",
            summary.has_angular_velocity ? " angular_velocity" : "");
        text += line("fields", fields.substr(std::min<std::size_t>(1, fields.size())));
        if (summary.has_position || summary.has_velocity || summary.has_angular_velocity)
            text += line("numbers", fmt::format("of {} bytes", summary.bytes_per_number));
        text += line("frames", frames_text(summary.steps));
    }
    return text;
}

std::string header_text(const CheckpointHeader& header) {
    std::string text = line("step", fmt::format("{}", header.step));
    text += line("radius", fmt::format("{:g}", header.radius));
    text += line("rule", fmt::format("collisions = \"{}\", micro_steps = {}, sync_every = {}",
                                     header.collisions, header.micro_steps, header.sync_every));
    text += line("collisions", fmt::format("{} with walls, {} of pairs", header.wall_collisions,
                                           header.pair_collisions));
    text += line("state hash", header.state_hash);
    text += line("scene", header.scene_name);
    try {
        const Effects effects = scene_of(header, {}).effects;
        if (effects.are_any()) text += line("effects", description(effects));
    } catch (const InputError&) { // another version's scene; the rest is good to know all the same
    }
    std::string overrides = header.scene_overrides;
    if (!overrides.empty()) overrides.pop_back(); // each ends its line
    std::replace(overrides.begin(), overrides.end(), '\n', ' ');
    return overrides.empty() ? text : text + line("set", overrides);
}

ExitCode info(const std::string& path, const Communicator& ranks) {
    check_damage(path, ranks);
    FileSummary summary;
    int is_checkpoint = 0;
    std::string span;
    let_root(ranks, [&] {
        const FrameFile file(path);
        summary = file.summary();
        if (summary.kind == FileKind::collisions) span = span_text(file);
        is_checkpoint = summary.kind == FileKind::checkpoint ? 1 : 0;
    });
    ranks.broadcast(is_checkpoint);
    CheckpointHeader header;
    if (is_checkpoint == 1) header = read_checkpoint_header(path, ranks);
    if (ranks.is_root())
        fmt::print("{}{}", summary_text(summary), is_checkpoint == 1 ? header_text(header) : span);
    return ExitCode::success;
}

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What no state of a run can be; empty if all is well.
std::string flaw_of(const Disc& disc, double spin, double radius, const CheckpointHeader& header,
                    const Extent& box) {
    const double clock = header.clock();
    if (disc.has_departed())
        return disc.vx == 0 && disc.vy == 0
                   ? ""
                   : fmt::format("disc {} has left the box, yet moves", disc.id);
    const Disc shown = header.frame.in_box(disc, clock);
    const double x = shown.x, y = shown.y;
    // A disc may stand a little beyond its wall for the rest of a micro-step, or by the rounding of
    // L - r.
    const double slack = 1e-6 * header.radius + 0x1p-50 * header.box_size;
    const double margin = radius - slack;
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(disc.vx) ||
        !std::isfinite(disc.vy) || !std::isfinite(spin))
        return fmt::format("disc {} has a number that is not finite", disc.id);
    if (x < box.x_low + margin || x > box.x_high - margin || y < box.y_low + margin ||
        y > box.y_high - margin)
        return fmt::format("disc {} is outside the box, at ({}, {})", disc.id, x, y);
    if (!(disc.tau >= 0 && disc.tau <= clock))
        return fmt::format("disc {} has the time {}, and it is {} now", disc.id, disc.tau, clock);
    return {};
}

/// Bytes and hash are checked by reading; then the discs themselves. **Collective.**
void verify_checkpoint(const std::string& path, const Communicator& ranks) {
    const Checkpoint checkpoint = read_checkpoint(path, ranks);
    const Effects effects =
        scene_of(checkpoint.header, {}).effects; // a scene that cannot be read is no use either
    Extent box = extent_at(effects, checkpoint.header.box_size,
                           static_cast<double>(checkpoint.header.step));
    const SpeciesTable species_table(effects.species, checkpoint.header.radius);
    const auto make_room = [&](std::size_t side, double& line, double outwards) {
        if (effects.boundaries[side].kind == BoundaryKind::open)
            line = outwards * infinity; // discs may be on their way out
        if (effects.boundaries[side].kind == BoundaryKind::periodic)
            line += outwards * checkpoint.header.radius; // centres are anywhere in the box
    };
    make_room(0, box.x_low, -1);
    make_room(1, box.x_high, 1);
    make_room(2, box.y_low, -1);
    make_room(3, box.y_high, 1);
    std::string flaw;
    std::uint64_t sums[] = {0, 0};
    for (std::size_t i = 0; i < checkpoint.discs.size(); ++i) {
        const Disc& disc = checkpoint.discs[i];
        const double spin = checkpoint.spins.empty() ? 0 : checkpoint.spins[i];
        if (flaw.empty())
            flaw = flaw_of(disc, spin, species_table.of(disc.id).radius, checkpoint.header, box);
        sums[0] += disc.wall_collisions;
        sums[1] += disc.pair_collisions;
    }
    ranks.sum(sums);
    if (flaw.empty() && (sums[0] != checkpoint.header.wall_collisions ||
                         sums[1] != 2 * checkpoint.header.pair_collisions))
        flaw = "the discs' collisions do not add up";
    agree(ranks, flaw.empty(), path + ": " + flaw, ExitCode::bad_input);
}

void refuse(const std::string& path, const std::string& text) {
    throw InputError({{path, 0, text}});
}

/// Whether a run could show a disc there. Discs leave an open side as their centre is a radius
/// beyond it, and lie there at rest; in the time-stepped method a disc that another one has pushed
/// out may fly to the end of its micro-step before.
bool is_possible(const FrameRow& row, const FileSummary& summary) {
    if (!std::isfinite(row.vx) || !std::isfinite(row.vy) || !std::isfinite(row.angular_velocity))
        return false;
    if (!summary.has_position) return true;
    if (!std::isfinite(row.x) || !std::isfinite(row.y)) return false;
    const double l = summary.box_size, rounding = summary.bytes_per_number == 4 ? 0x1p-22 : 0x1p-50;
    const double reach = summary.radius + rounding * (l + summary.radius);
    const std::array<double, 4> beyond = {-row.x, row.x - l, -row.y, row.y - l},
                                rate = {-row.vx, row.vx, -row.vy, row.vy};
    const bool is_at_rest = summary.has_velocity && row.vx == 0 && row.vy == 0;
    bool has_left = false;
    for (std::size_t side = 0; side < beyond.size(); ++side)
        has_left |= summary.open_boundaries[side] && is_at_rest && beyond[side] > 0 &&
                    beyond[side] <= reach; // smaller discs than the largest leave before
    for (std::size_t side = 0; side < beyond.size(); ++side) {
        if (beyond[side] <= 0) continue;
        if (!summary.open_boundaries[side]) return false;
        // Without velocities nobody knows how far it flies; pushed out over a corner it leaves by
        // one side and keeps its place along it.
        const bool is_bounded = summary.has_velocity && !has_left;
        if (is_bounded && beyond[side] > reach + std::max(0.0, rate[side])) return false;
    }
    return true;
}

void verify_frames(const FrameFile& file, const std::string& path) {
    const FileSummary& summary = file.summary();
    std::vector<FrameRow> rows;
    for (std::size_t frame = 0; frame < summary.steps.size(); ++frame) {
        if (frame > 0 && summary.steps[frame] <= summary.steps[frame - 1])
            refuse(path, fmt::format("frame {} goes back in time", frame));
        for (std::uint64_t begin = 0; begin < summary.n_discs; begin += rows_at_a_time) {
            file.read(frame, begin, std::min(begin + rows_at_a_time, summary.n_discs), rows);
            for (std::size_t i = 0; i < rows.size(); ++i) {
                if (!is_possible(rows[i], summary))
                    refuse(path, fmt::format("disc {} is outside the box or not finite at step {}",
                                             begin + i, summary.steps[frame]));
            }
        }
    }
}

void verify_log(const FrameFile& file, const std::string& path) {
    std::vector<LoggedCollision> rows;
    LoggedCollision last;
    for (std::uint64_t begin = 0; begin < file.summary().n_logged; begin += rows_at_a_time) {
        file.read(begin, std::min(begin + rows_at_a_time, file.summary().n_logged), rows);
        for (const LoggedCollision& row : rows) {
            if (row.step < last.step || row.time < last.time)
                refuse(path, fmt::format("goes back in time at step {}", row.step));
            if (row.p < 0 || row.q < -1 || row.p == row.q)
                refuse(path, fmt::format("has a collision of {} and {}", row.p, row.q));
            last = row;
        }
    }
}

ExitCode verify(const std::string& path, const Communicator& ranks) {
    check_damage(path, ranks);
    int is_checkpoint = 0;
    let_root(ranks, [&] {
        const FrameFile file(path);
        is_checkpoint = file.summary().kind == FileKind::checkpoint ? 1 : 0;
        if (file.summary().kind == FileKind::trajectory) verify_frames(file, path);
        if (file.summary().kind == FileKind::collisions) verify_log(file, path);
    });
    ranks.broadcast(is_checkpoint);
    if (is_checkpoint == 1) verify_checkpoint(path, ranks);
    if (ranks.is_root()) fmt::print("{}: whole\n", path);
    return ExitCode::success;
}

ExitCode diff(const std::string& a, const std::string& b, const Communicator& ranks) {
    for (const std::string& path : {a, b}) check_damage(path, ranks);
    int is_same = 1;
    let_root(ranks, [&] {
        const FileDifference difference = compare_files(a, b);
        is_same = difference.is_same ? 1 : 0;
        if (difference.is_same) return;
        fmt::print("first: {}\nlargest: {} ({})\n", difference.first, difference.largest,
                   difference.largest_in);
    });
    ranks.broadcast(is_same);
    return is_same == 1 ? ExitCode::success : ExitCode::difference;
}

enum class Format { xyz, text, csv };

void append_header(fmt::memory_buffer& out, Format format, const FileSummary& summary,
                   std::int64_t step) {
    if (format != Format::xyz) return;
    fmt::format_to(std::back_inserter(out),
                   "{}\nLattice=\"{} 0 0 0 {} 0 0 0 1\" "
                   "Properties=species:S:1:pos:R:3:velo:R:3:id:I:1{} Time={} pbc=\"{} {} F\"\n",
                   summary.n_discs, summary.box_size, summary.box_size,
                   summary.has_angular_velocity ? ":angular_velocity:R:1" : "", step,
                   summary.is_periodic_x ? 'T' : 'F', summary.is_periodic_y ? 'T' : 'F');
}

void append_row(fmt::memory_buffer& out, Format format, std::int64_t step, std::uint64_t id,
                const FrameRow& row, const FileSummary& summary) {
    const auto end = std::back_inserter(out);
    const bool with_counters = summary.has_collisions;
    if (format == Format::xyz)
        fmt::format_to(end, "D {} {} 0 {} {} 0 {}", row.x, row.y, row.vx, row.vy, id);
    if (format == Format::csv) { // counters that the file does not have stay empty
        fmt::format_to(end, "{},{},{},{},{},{},", step, id, row.x, row.y, row.vx, row.vy);
        if (with_counters)
            fmt::format_to(end, "{},{}", row.pair_collisions, row.wall_collisions);
        else
            fmt::format_to(end, ",");
    }
    if (format != Format::text) {
        if (summary.has_angular_velocity)
            fmt::format_to(end, "{}{}", format == Format::csv ? ',' : ' ', row.angular_velocity);
        out.push_back('\n');
    }
    if (format == Format::text)
        append_line(out, step,
                    {id, row.x, row.y, row.vx, row.vy, row.pair_collisions, row.wall_collisions},
                    RunOptions::round_trip_digits, with_counters);
}

void write_frames(const FrameFile& file, Format format, DataOutput& output) {
    const FileSummary& summary = file.summary();
    if (format == Format::csv)
        output.buffer().append(
            fmt::format("step,id,x,y,vx,vy,pair_collisions,wall_collisions{}\n",
                        summary.has_angular_velocity ? ",angular_velocity" : ""));
    std::vector<FrameRow> rows;
    for (std::size_t frame = 0; frame < summary.steps.size() && output.failure().empty(); ++frame) {
        append_header(output.buffer(), format, summary, summary.steps[frame]);
        for (std::uint64_t begin = 0; begin < summary.n_discs; begin += rows_at_a_time) {
            file.read(frame, begin, std::min(begin + rows_at_a_time, summary.n_discs), rows);
            for (std::size_t i = 0; i < rows.size(); ++i) {
                append_row(output.buffer(), format, summary.steps[frame], begin + i, rows[i],
                           summary);
                output.flush_if_full();
            }
        }
    }
}

void write_log(const FrameFile& file, DataOutput& output) {
    output.buffer().append(std::string_view("step,time,p,q,impulse\n"));
    std::vector<LoggedCollision> rows;
    for (std::uint64_t begin = 0; begin < file.summary().n_logged && output.failure().empty();
         begin += rows_at_a_time) {
        file.read(begin, std::min(begin + rows_at_a_time, file.summary().n_logged), rows);
        for (const LoggedCollision& row : rows) {
            fmt::format_to(std::back_inserter(output.buffer()), "{},{},{},{},{}\n", row.step,
                           row.time, row.p, row.q, row.impulse);
            output.flush_if_full();
        }
    }
}

ExitCode convert(const std::string& path, Format format, const std::string& target,
                 const Communicator& ranks) {
    check_damage(path, ranks);
    std::string failure;
    let_root(ranks, [&] {
        if (!target.empty()) {
            std::vector<Problem> problems = problems_with({{"--output", target, true}},
                                                          {{"the file to convert", path}});
            if (!problems.empty()) throw InputError(std::move(problems));
        }
        const FrameFile file(path);
        const bool is_log = file.summary().kind == FileKind::collisions;
        if (is_log && format != Format::csv)
            refuse(path, "is a log of collisions; it can be converted to csv only");
        if (!is_log && format != Format::csv &&
            (!file.summary().has_position || !file.summary().has_velocity))
            refuse(path, "has no positions or no velocities; convert it to csv");
        DataOutput output(target);
        if (is_log)
            write_log(file, output);
        else
            write_frames(file, format, output);
        output.flush();
        output.close();
        failure = output.failure();
    });
    agree(ranks, failure.empty(), failure, ExitCode::output_failure);
    return ExitCode::success;
}

/// The words of the commands; they live as long as the actions that use them.
struct FileWords {
    std::string a, b, to, output;
};

CLI::App* declare(CLI::App& app, const char* name, const char* what, const char* file,
                  std::string& path) {
    CLI::App* command = app.add_subcommand(name, what);
    command->set_help_flag("-h,--help", "Print this help and exit");
    command->add_option(file, path, "A checkpoint, a trajectory or a log of collisions")
        ->type_name("")
        ->required();
    return command;
}

} // namespace

void add_file_commands(CLI::App& app, Action& action) {
    const auto words = std::make_shared<FileWords>();
    declare(app, "info", "Say what is in a file", "FILE", words->a)->callback([words, &action] {
        action = [words](const Communicator& ranks) { return info(words->a, ranks); };
    });
    declare(app, "verify",
            "Check a file: every byte, the state hash, the discs; exit code 2 if it is damaged",
            "FILE", words->a)
        ->callback([words, &action] {
            action = [words](const Communicator& ranks) { return verify(words->a, ranks); };
        });
    CLI::App* compare = declare(app, "diff", "Compare two files; exit code 1 if they differ", "A",
                                words->a);
    compare->add_option("B", words->b, "Another of the same kind")->type_name("")->required();
    compare->callback([words, &action] {
        action = [words](const Communicator& ranks) { return diff(words->a, words->b, ranks); };
    });
    CLI::App* translate = declare(
        app, "convert",
        "Write a file as text: extended XYZ (OVITO opens it), lines as of `run`, or CSV", "FILE",
        words->a);
    translate->add_option("--to", words->to, "xyz, text or csv")
        ->required()
        ->check(CLI::IsMember({"xyz", "text", "csv"}));
    translate->add_option("--output", words->output, "A file, instead of standard output")
        ->type_name("FILE");
    translate->callback([words, &action] {
        const Format format = words->to == "xyz"    ? Format::xyz
                              : words->to == "text" ? Format::text
                                                    : Format::csv;
        action = [words, format](const Communicator& ranks) {
            return convert(words->a, format, words->output, ranks);
        };
    });
}

} // namespace carrom
