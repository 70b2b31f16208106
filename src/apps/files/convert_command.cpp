// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/subcommands.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "apps/run_command/command_options.hpp"
#include "apps/run_command/disc_lines.hpp"
#include "core/side_columns.hpp"
#include "io/checkpoint.hpp"
#include "io/frame_file.hpp"
#include "parallel/agreement.hpp"
#include "run/files/data_output.hpp"
#include "run/files/destinations.hpp"

namespace carrom {

namespace {

enum class Format { xyz, text, csv };

/// Columns that every CSV table of discs has; they are empty if the source file lacks them.
constexpr std::array<std::string_view, 6> common_columns = {
    "x", "y", "vx", "vy", "pair_collisions", "wall_collisions"};

/// The indices of the file's columns that are not in `common_columns`.
std::vector<std::size_t> other_columns(const FileSummary& summary) {
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < summary.columns.size(); ++k)
        if (std::find(common_columns.begin(), common_columns.end(), summary.columns[k]) ==
            common_columns.end())
            places.push_back(k);
    return places;
}

/// Names of species: readers of extended XYZ accept only chemical symbols. X is a dummy symbol.
constexpr std::array<std::string_view, 119> symbols = {
    "X",  "H",  "He", "Li", "Be", "B",  "C",  "N",  "O",  "F",  "Ne", "Na", "Mg", "Al", "Si",
    "P",  "S",  "Cl", "Ar", "K",  "Ca", "Sc", "Ti", "V",  "Cr", "Mn", "Fe", "Co", "Ni", "Cu",
    "Zn", "Ga", "Ge", "As", "Se", "Br", "Kr", "Rb", "Sr", "Y",  "Zr", "Nb", "Mo", "Tc", "Ru",
    "Rh", "Pd", "Ag", "Cd", "In", "Sn", "Sb", "Te", "I",  "Xe", "Cs", "Ba", "La", "Ce", "Pr",
    "Nd", "Pm", "Sm", "Eu", "Gd", "Tb", "Dy", "Ho", "Er", "Tm", "Yb", "Lu", "Hf", "Ta", "W",
    "Re", "Os", "Ir", "Pt", "Au", "Hg", "Tl", "Pb", "Bi", "Po", "At", "Rn", "Fr", "Ra", "Ac",
    "Th", "Pa", "U",  "Np", "Pu", "Am", "Cm", "Bk", "Cf", "Es", "Fm", "Md", "No", "Lr", "Rf",
    "Db", "Sg", "Bh", "Hs", "Mt", "Ds", "Rg", "Cn", "Nh", "Fl", "Mc", "Lv", "Ts", "Og"};

/// Finds the species of discs, which are passed in order of id.
class Bodies {
public:
    explicit Bodies(const FileSummary& summary)
        : species_(summary.species), all_{summary.n_rows, summary.radius, 1} {}
    /// Returns the species of a disc. Call it in order of id; id 0 begins a new frame.
    const Species& of(std::uint64_t id) {
        if (id == 0) k_ = 0, end_ = species_.empty() ? all_.count : species_[0].count;
        while (id >= end_) end_ += species_[++k_].count;
        return species_.empty() ? all_ : species_[k_];
    }
    /// The symbol of the disc that was last passed to `of`: H, He, ... for species 0, 1, ...; X if
    /// there are no species or too many.
    std::string_view symbol() const {
        return species_.empty() || species_.size() >= symbols.size() ? symbols[0] : symbols[k_ + 1];
    }

private:
    std::span<const Species> species_;
    Species all_;
    std::size_t k_ = 0;
    std::uint64_t end_ = 0;
};

/// The first two lines of a frame of extended XYZ. OVITO reads velocities from `velo`; ASE computes
/// them from `momenta` and `mass`.
void append_header(fmt::memory_buffer& out, const FileSummary& summary, std::size_t frame) {
    const Box& box = summary.boxes.empty() ? summary.box : summary.boxes[frame];
    std::string others;
    for (const std::size_t k : other_columns(summary))
        others += fmt::format(":{}:R:1", summary.columns[k]);
    std::string corner; // position of the box's corner, as OVITO reads it
    if (summary.origin != std::array<double, 2>{})
        corner = fmt::format("Origin=\"{} {} 0\" ", 0 - summary.origin[0], 0 - summary.origin[1]);
    fmt::format_to(std::back_inserter(out),
                   "{}\nLattice=\"{} 0 0 0 {} 0 0 0 1\" {}"
                   "Properties=species:S:1:pos:R:3:velo:R:3:id:I:1:radius:R:1:mass:R:1:"
                   "momenta:R:3{} Time={} "
                   "pbc=\"{} {} F\"\n",
                   summary.n_rows, box.x, box.y, corner, others, summary.steps[frame],
                   summary.is_periodic_x ? 'T' : 'F', summary.is_periodic_y ? 'T' : 'F');
}

/// Writes rows of frames as text.
class RowWriter {
public:
    RowWriter(const FileSummary& summary, Format format)
        : format_(format), bodies_(summary),
          radius_now_(summary.place_of(info_of(SideColumn::swapped_radius).shown)),
          others_(other_columns(summary)) {
        for (const std::string_view column : common_columns)
            places_.push_back(summary.place_of(column));
    }

    void append(fmt::memory_buffer& out, std::int64_t step, std::uint64_t id, const Rows& rows,
                std::size_t i) {
        if (format_ == Format::text) return append_as_text(out, step, id, rows, i);
        const auto end = std::back_inserter(out);
        const char separator = format_ == Format::xyz ? ' ' : ',';
        if (format_ == Format::xyz) {
            Species body = bodies_.of(id);
            if (radius_now_ < rows.size()) body.radius = rows[radius_now_][i];
            const double vx = number(rows, i, 2), vy = number(rows, i, 3);
            fmt::format_to(end, "{} {} {} 0 {} {} 0 {} {} {} {} {} 0", bodies_.symbol(),
                           number(rows, i, 0), number(rows, i, 1), vx, vy, id, body.radius,
                           body.mass, body.mass * vx, body.mass * vy);
        } else {
            fmt::format_to(end, "{},{}", step, id);
            for (const std::size_t place : places_) { // columns that the file lacks stay empty
                out.push_back(',');
                if (place < rows.size()) fmt::format_to(end, "{}", rows[place][i]);
            }
        }
        for (const std::size_t k : others_) fmt::format_to(end, "{}{}", separator, rows[k][i]);
        out.push_back('\n');
    }

private:
    /// The number in a common column, or 0 if the file lacks the column.
    double number(const Rows& rows, std::size_t i, std::size_t column) const {
        return places_[column] < rows.size() ? rows[places_[column]][i] : 0;
    }
    void append_as_text(fmt::memory_buffer& out, std::int64_t step, std::uint64_t id,
                        const Rows& rows, std::size_t i) const {
        append_line(out, step,
                    {id, number(rows, i, 0), number(rows, i, 1), number(rows, i, 2),
                     number(rows, i, 3), static_cast<std::uint64_t>(number(rows, i, 4)),
                     static_cast<std::uint64_t>(number(rows, i, 5))},
                    RunOptions::round_trip_digits, places_[4] < rows.size());
    }

    Format format_;
    Bodies bodies_;
    std::size_t radius_now_; ///< column of present radii, if discs exchange radii
    std::vector<std::size_t> places_, others_;
};

void write_frames(const FrameFile& file, Format format, DataOutput& output) {
    const FileSummary& summary = file.summary();
    RowWriter writer(summary, format);
    if (format == Format::csv) {
        fmt::format_to(std::back_inserter(output.buffer()), "step,id,{}",
                       fmt::join(common_columns, ","));
        for (const std::size_t k : other_columns(summary))
            fmt::format_to(std::back_inserter(output.buffer()), ",{}", summary.columns[k]);
        output.buffer().push_back('\n');
    }
    Rows rows;
    for (std::size_t frame = 0; frame < summary.steps.size() && output.failure().empty(); ++frame) {
        if (format == Format::xyz) append_header(output.buffer(), summary, frame);
        for (std::uint64_t begin = 0; begin < summary.n_rows; begin += rows_at_a_time) {
            const std::uint64_t end = std::min(begin + rows_at_a_time, summary.n_rows);
            file.read_shown(frame, begin, end, rows);
            for (std::size_t i = 0; i < end - begin; ++i) {
                writer.append(output.buffer(), summary.steps[frame], begin + i, rows, i);
                output.flush_if_full();
            }
        }
    }
}

void write_log(const FrameFile& file, DataOutput& output) {
    const FileSummary& summary = file.summary();
    const auto out = std::back_inserter(output.buffer());
    fmt::format_to(out, "{}\n", fmt::join(summary.columns, ","));
    Rows rows;
    for (std::uint64_t begin = 0; begin < summary.n_rows && output.failure().empty();
         begin += rows_at_a_time) {
        const std::uint64_t end = std::min(begin + rows_at_a_time, summary.n_rows);
        file.read(0, begin, end, rows);
        for (std::size_t i = 0; i < end - begin; ++i) {
            for (std::size_t k = 0; k < rows.size(); ++k)
                fmt::format_to(out, "{}{}", k == 0 ? "" : ",", rows[k][i]);
            output.buffer().push_back('\n');
            output.flush_if_full();
        }
    }
}

/// The reason why a file cannot be written in `format`; empty if it can.
std::string reason_against(const FileSummary& summary, Format format) {
    if (format == Format::csv) return {};
    if (summary.kind == FileKind::collisions)
        return "is a log of collisions; it can be converted to csv only";
    if (!summary.has("x") || !summary.has("vx"))
        return "has no positions or no velocities; convert it to csv";
    return {};
}

/// Converts the file on one rank. Returns why the output could not be written, or an empty text.
std::string convert_alone(const std::string& path, Format format, const std::string& target) {
    const FrameFile file(path);
    std::vector<NamedFile> sources = {{"the file to convert", path}};
    for (const std::string& segment : file.segments())
        sources.push_back({"a part of the file to convert", segment});
    std::vector<Problem> problems;
    if (!target.empty()) problems = problems_with({{"--output", target}}, sources);
    if (!problems.empty()) throw InputError(std::move(problems));
    file.check_numbers();
    if (const std::string failure = reason_against(file.summary(), format); !failure.empty())
        throw InputError({{path, 0, failure}});
    DataOutput output(target);
    if (file.summary().kind == FileKind::collisions)
        write_log(file, output);
    else
        write_frames(file, format, output);
    output.flush();
    output.close();
    return output.failure();
}

/// Runs `carrom convert`. **Collective.**
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
  carrom convert kept/checkpoint-000000001000.h5 --to text | head

The command carrom-import of the Python package does the reverse; it takes GSD and LAMMPS, too.)";
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
