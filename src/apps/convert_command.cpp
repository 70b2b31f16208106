// SPDX-License-Identifier: BSD-3-Clause
#include "apps/file_commands.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "apps/data_output.hpp"
#include "apps/destinations.hpp"
#include "apps/disc_lines.hpp"
#include "apps/run_options.hpp"
#include "io/checkpoint.hpp"
#include "io/frame_file.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

namespace {

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

/// What keeps a file from being written in that format; empty if nothing does.
std::string obstacle_to_format(const FileSummary& summary, Format format) {
    if (format == Format::csv) return {};
    if (summary.kind == FileKind::collisions)
        return "is a log of collisions; it can be converted to csv only";
    if (!summary.has_position || !summary.has_velocity)
        return "has no positions or no velocities; convert it to csv";
    return {};
}

/// Returns what went wrong with the output.
std::string convert_alone(const std::string& path, Format format, const std::string& target) {
    std::vector<Problem> problems;
    if (!target.empty())
        problems = problems_with({{"--output", target, true}}, {{"the file to convert", path}});
    if (!problems.empty()) throw InputError(std::move(problems));
    const FrameFile file(path);
    if (const std::string obstacle = obstacle_to_format(file.summary(), format); !obstacle.empty())
        throw InputError({{path, 0, obstacle}});
    DataOutput output(target);
    if (file.summary().kind == FileKind::collisions)
        write_log(file, output);
    else
        write_frames(file, format, output);
    output.flush();
    output.close();
    return output.failure();
}

/// **Collective.**
ExitCode convert(const std::string& path, Format format, const std::string& target,
                 const Communicator& ranks) {
    check_damage(path, ranks);
    std::string failure;
    let_root(ranks, [&] { failure = convert_alone(path, format, target); });
    agree(ranks, failure.empty(), failure, ExitCode::output_failure);
    return ExitCode::success;
}

std::optional<Format> format_of(const std::string& word) {
    if (word == "xyz") return Format::xyz;
    if (word == "text") return Format::text;
    if (word == "csv") return Format::csv;
    return std::nullopt;
}

} // namespace

Subcommand convert_subcommand() {
    constexpr const char* examples = R"(Examples:
  carrom convert trajectory.h5 --to xyz > discs.xyz
  carrom convert collisions.h5 --to csv --output collisions.csv
  carrom convert kept/checkpoint-000000001000.h5 --to text | head)";
    struct Words {
        std::string file, format, output;
    };
    const auto words = std::make_shared<Words>();
    const auto action = [words](std::vector<Problem>& problems) -> Action {
        const std::optional<Format> format = format_of(words->format);
        if (!format)
            problems.push_back(
                {"--to", 0, "must be xyz, text or csv, not \"" + words->format + '"'});
        if (!problems.empty()) return failing(problems);
        return {[words, format = *format](const Communicator& ranks) {
            return convert(words->file, format, words->output, ranks);
        }};
    };
    return {"convert",
            "Write a file as text: extended XYZ (OVITO opens it), lines as of `run`, or CSV",
            examples,
            {{"FILE", "", help_of_file, &words->file, true},
             {"--to", "xyz|text|csv", "The format", &words->format, true},
             {"--output", "FILE", "A file, instead of standard output", &words->output}},
            action};
}

} // namespace carrom
