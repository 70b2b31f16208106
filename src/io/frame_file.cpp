// SPDX-License-Identifier: BSD-3-Clause
#include "io/frame_file.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/computed_fields.hpp"
#include "io/checked_dataset.hpp"
#include "io/checkpoint_fields.hpp"
#include "io/checksums.hpp"
#include "io/child_process.hpp"
#include "io/files.hpp"
#include "io/h5md.hpp"
#include "io/segments.hpp"

namespace carrom {

/// Where a column is in a file: number `place` of the `width` numbers in a row of a data set.
struct ColumnSource {
    std::string column, dataset;
    hsize_t width = 1, place = 0;
};

namespace {

constexpr const char *radii_path = "/particles/discs/radius",
                     *masses_path = "/particles/discs/mass";
constexpr std::size_t longest_word = 1000;
constexpr std::uint64_t bodies_at_a_time = std::uint64_t{1} << 16;

/// The sources of columns, in the order of FileSummary::columns.
std::vector<ColumnSource> sources_of_frames() {
    std::vector<ColumnSource> sources = {{"x", "position", 3, 0},
                                         {"y", "position", 3, 1},
                                         {"vx", "velocity", 3, 0},
                                         {"vy", "velocity", 3, 1},
                                         {"pair_collisions", "collisions", 2, 1},
                                         {"wall_collisions", "collisions", 2, 0}};
    for (const ComputedField& field : computed_field_table)
        for (std::size_t k = 0; k < field.width(); ++k)
            sources.push_back({field.columns[k], field.name, field.width(), k});
    sources.push_back({"image_x", "image", 3, 0});
    sources.push_back({"image_y", "image", 3, 1});
    for (const SideColumnInfo& info : side_column_table)
        sources.push_back({info.shown, info.shown, 1, 0});
    for (ColumnSource& source : sources)
        source.dataset = h5md::discs_path + source.dataset + "/value";
    return sources;
}

std::vector<ColumnSource> sources_of_logs() {
    std::vector<ColumnSource> sources;
    for (const char* name : {"step", "time", "p", "q", "impulse"})
        sources.push_back({name, std::string(h5md::collisions_path) + name});
    return sources;
}

/// Reads rows of a data set, `width` numbers each, as doubles.
std::vector<double> read_block(hid_t file, const std::string& path, const h5::RowRange& rows,
                               hsize_t width = 1) {
    const h5::Dataset dataset = h5::open_checked(file, path);
    const std::vector<hsize_t> sizes = h5::dimensions_of(dataset.id());
    if (sizes.empty() || sizes.size() > 3 || (sizes.size() == 3 ? sizes[2] : 1) != width)
        throw FileError(path + " has another shape than this program writes");
    const bool has_frames = sizes.size() > 1;
    if (rows.end > sizes[has_frames ? 1 : 0] || (has_frames && rows.frame >= sizes[0]))
        throw FileError(path + " is shorter than the others");
    std::vector<double> numbers((rows.end - rows.begin) * width);
    h5::read_rows(dataset.id(), rows, H5T_NATIVE_DOUBLE, numbers.data());
    return numbers;
}

/// Returns the boxes of all frames. Throws FileError if an edge is not a finite number above 0.
std::vector<Box> boxes_of_frames(hid_t file, std::size_t n_frames) {
    const h5::Dataset dataset = h5::open_checked(file, h5md::edges_path, h5::Shape{n_frames, 3});
    h5::check_storage(dataset, h5md::edges_path);
    std::vector<double> edges(3 * n_frames);
    h5::checked(
        H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, edges.data()),
        h5md::edges_path);
    for (const double edge : edges)
        if (!(std::isfinite(edge) && edge > 0))
            throw FileError("has a box with an edge that is no finite number above 0");
    std::vector<Box> boxes;
    for (std::size_t k = 0; k < edges.size(); k += 3) boxes.emplace_back(edges[k], edges[k + 1]);
    return boxes;
}

/// Returns the words of an attribute, all of the same length, as one text.
std::string letters_of(hid_t file, const char* object, const char* name, hssize_t n_words) {
    const h5::Attribute attribute(
        h5::checked(H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT), name));
    const h5::Type type(h5::checked(H5Aget_type(attribute.id()), name));
    const h5::Space shape(h5::checked(H5Aget_space(attribute.id()), name));
    const bool is_text = H5Tget_class(type.id()) == H5T_STRING &&
                         H5Tis_variable_str(type.id()) == 0 &&
                         H5Tget_size(type.id()) <= longest_word;
    if (!is_text || H5Sget_simple_extent_npoints(shape.id()) != n_words)
        throw FileError("was written by another program");
    std::string letters(H5Tget_size(type.id()) * static_cast<std::size_t>(n_words), '\0');
    h5::checked(H5Aread(attribute.id(), type.id(), letters.data()), name);
    return letters;
}

/// Reads the description of the system of discs, which all files have.
void read_system(hid_t file, std::uint64_t n_discs, RecordedSystem& system) {
    system.program_version = letters_of(file, "/h5md/creator", "version", 1);
    h5::read_scalar(file, "/parameters/radius", system.radius);
    if (n_discs > 0) system.species = read_species(file, h5md::shown_species_path, n_discs);
    const std::string boundary = letters_of(file, "/particles/discs/box", "boundary", 3);
    system.is_periodic_x = boundary.starts_with("periodic");
    system.is_periodic_y = boundary.substr(boundary.size() / 3).starts_with("periodic");
    const auto read_sides = [&](const char* path, auto& sides) {
        if (!h5::has(file, path)) return;
        const std::vector<double> numbers = read_block(file, path, {0, sides.size()});
        std::copy(numbers.begin(), numbers.end(), sides.begin());
    };
    read_sides("/parameters/open_sides", system.open_boundaries);
    read_sides("/parameters/wall_amplitudes", system.amplitudes);
    read_sides("/parameters/origin", system.origin);
    if (!std::isfinite(system.origin[0]) || !std::isfinite(system.origin[1]))
        throw FileError("has an origin that is no finite number");
}

/// Throws FileError unless all radii and masses, which other programs read, are finite and above 0.
void check_bodies(hid_t file, const FileSummary& summary) {
    for (const char* path : {radii_path, masses_path}) {
        if (!h5::has(file, path)) continue;
        for (std::uint64_t begin = 0; begin < summary.n_rows; begin += bodies_at_a_time) {
            const std::uint64_t end = std::min(begin + bodies_at_a_time, summary.n_rows);
            for (const double number : read_block(file, path, {begin, end}))
                if (!(std::isfinite(number) && number > 0))
                    throw FileError(std::string(path) + " holds what is no finite number above 0");
        }
    }
}

/// Whether the disc in row `i` of a frame has left the box: such discs rest outside of an open
/// side.
bool has_departed(const Rows& rows, std::size_t i, const FileSummary& summary) {
    const auto number = [&](const char* column) { return rows[summary.place_of(column)][i]; };
    const double x = number("x"), y = number("y");
    const std::array<bool, 4> are_beyond = {x<0, x> summary.box.x, y<0, y> summary.box.y};
    for (std::size_t side = 0; side < are_beyond.size(); ++side)
        if (summary.open_boundaries[side] && are_beyond[side])
            return number("vx") == 0 && number("vy") == 0;
    return false;
}

template <class Act> void with_path(const std::string& path, const Act& act) {
    try {
        act();
    } catch (const FileError& error) {
        throw InputError({{path, 0, with_remedy(error)}});
    }
}

} // namespace

std::size_t FileSummary::place_of(std::string_view column) const {
    return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), column) -
                                    columns.begin());
}

struct FrameFile::State {
    h5::File file;
    CheckpointHeader header;           ///< the header of a checkpoint
    std::vector<ColumnSource> sources; ///< the columns of a recording
    std::vector<FileSegment> segments; ///< the segments of a recording
};

FrameFile::FrameFile(const std::string& path) : path_(path), state_(std::make_unique<State>()) {
    with_path(path_, [&] {
        inspect_in_child_first([&] {
            open();
            try_all_parts();
        });
    });
}

FrameFile::~FrameFile() = default;
FrameFile::FrameFile(FrameFile&&) noexcept = default;

void FrameFile::open() {
    summary_ = {};
    const std::optional<Index> index = read_checked_index(path_, false);
    if (index) state_->segments = index->segments;
    state_->file = h5::open_file(path_, h5::Access::read);
    const hid_t file = state_->file.id();
    if (!index && h5::has(file, "/carrom/recording"))
        throw FileError("is damaged: it does not end with a checksum, as this program writes it");
    summary_.has_checksums = index || h5::has(file, run_path);
    if (!summary_.has_checksums && has_traces_of_checkpoint(path_))
        throw FileError("is damaged: it has traces of a checkpoint, and is none");
    if (h5::has(file, run_path)) {
        const CheckpointHeader& header = state_->header = read_header(file);
        summary_.columns = {"x", "y", "vx", "vy", "pair_collisions", "wall_collisions"};
        header.columns.for_each(
            [&](SideColumn column) { summary_.columns.push_back(info_of(column).shown); });
        summary_.n_rows = header.n_discs;
        summary_.box = header.box();
        summary_.steps = {header.step};
        summary_.state_hash = header.state_hash;
    } else if (h5::has(file, "/carrom/collisions")) {
        summary_.kind = FileKind::collisions;
        if (h5::has(file, h5md::gaps_path))
            summary_.gaps = h5::read_column<std::int64_t>(file, h5md::gaps_path);
        if (summary_.gaps.size() % 2 != 0) throw FileError("its gaps are no pairs of steps");
        for (const ColumnSource& source : state_->sources = sources_of_logs())
            summary_.columns.push_back(source.column);
        summary_.n_rows = h5::n_rows_of(
            h5::open_checked(file, state_->sources.front().dataset, h5::Shape{std::nullopt}).id());
        if (h5::has(file, radii_path))
            summary_.n_discs = h5::n_rows_of(h5::open_checked(file, radii_path).id());
    } else if (h5::has(file, "/particles/discs")) {
        open_trajectory();
    } else {
        throw FileError("holds nothing that carrom writes");
    }
    read_system(file, summary_.kind == FileKind::collisions ? 0 : summary_.n_rows, summary_);
    const Box& box = summary_.box;
    const bool has_box = summary_.kind != FileKind::collisions && !summary_.steps.empty();
    if (!(std::isfinite(summary_.radius) && summary_.radius > 0) ||
        (has_box && !(std::isfinite(box.longest()) && box.shortest() > 0)))
        throw FileError("has a radius or a box that is no finite number above 0");
    if (has_box && summary_.n_rows == 0) throw FileError("has no discs");
}

void FrameFile::open_trajectory() {
    const hid_t file = state_->file.id();
    summary_.kind = FileKind::trajectory;
    summary_.steps = h5::read_column<std::int64_t>(file, h5md::step_path);
    state_->sources.clear();
    for (const ColumnSource& source : sources_of_frames()) {
        if (!h5::has(file, source.dataset)) continue;
        h5::Shape shape = {summary_.steps.size(), std::nullopt};
        if (source.width > 1) shape.push_back(source.width);
        const h5::Dataset values = h5::open_checked(file, source.dataset, shape);
        const h5::Type type = h5::stored_type(values.id());
        summary_.n_rows = h5::n_rows_of(values.id());
        if (H5Tget_class(type.id()) == H5T_FLOAT)
            summary_.bytes_per_number = H5Tget_size(type.id());
        summary_.columns.push_back(source.column);
        state_->sources.push_back(source);
    }
    if (summary_.steps.empty()) return;
    summary_.boxes = boxes_of_frames(file, summary_.steps.size());
    summary_.box = summary_.boxes.back();
}

/// Reads the first row of a checkpoint, or of each segment, so that the child process finds damage.
void FrameFile::try_all_parts() const {
    Rows rows;
    std::uint64_t first = 0;
    const std::uint64_t n = std::min<std::uint64_t>(1, summary_.n_rows);
    if (summary_.kind == FileKind::checkpoint) read(0, 0, n, rows);
    for (const FileSegment& segment : state_->segments) {
        if (segment.rows > 0 && summary_.kind == FileKind::trajectory) read(first, 0, n, rows);
        if (segment.rows > 0 && summary_.kind == FileKind::collisions)
            read(0, first, first + 1, rows);
        first += segment.rows;
    }
}

std::vector<std::string> FrameFile::segments() const {
    std::vector<std::string> paths;
    for (const FileSegment& segment : state_->segments)
        paths.push_back(segment_path(path_, segment.name));
    return paths;
}

void FrameFile::check_numbers() const {
    with_path(path_, [&] {
        static_cast<void>(read_checked_index(path_, true));
        if (summary_.kind == FileKind::trajectory) check_bodies(state_->file.id(), summary_);
    });
}

void FrameFile::read(std::size_t frame, std::uint64_t begin, std::uint64_t end, Rows& rows) const {
    rows.resize(summary_.columns.size());
    with_path(path_, [&] {
        if (summary_.kind == FileKind::checkpoint)
            read_state(begin, end, rows);
        else
            read_stored(frame, begin, end, rows);
    });
}

void FrameFile::read_shown(std::size_t frame, std::uint64_t begin, std::uint64_t end,
                           Rows& rows) const {
    read(frame, begin, end, rows);
    for (const auto& [column, origin] :
         {std::pair("x", summary_.origin[0]), std::pair("y", summary_.origin[1])})
        if (const std::size_t place = summary_.place_of(column); place < rows.size())
            for (double& number : rows[place]) number -= origin;
}

std::vector<std::uint64_t> FrameFile::find_departed(std::size_t frame) const {
    std::vector<std::uint64_t> departed;
    const FileSummary& summary = summary_;
    if (std::ranges::find(summary.open_boundaries, true) == summary.open_boundaries.end())
        return departed;
    Rows rows;
    for (std::uint64_t begin = 0; begin < summary.n_rows; begin += bodies_at_a_time) {
        const std::uint64_t end = std::min(begin + bodies_at_a_time, summary.n_rows);
        if (summary.kind == FileKind::checkpoint)
            with_path(path_, [&] {
                const auto times = read_block(state_->file.id(), "/carrom/discs/tau", {begin, end});
                for (std::uint64_t i = 0; i < times.size(); ++i)
                    if (times[i] == columns::departed_time) departed.push_back(begin + i);
            });
        else
            read(frame, begin, end, rows);
        for (std::uint64_t i = 0; i < end - begin && summary.kind != FileKind::checkpoint; ++i)
            if (has_departed(rows, i, summary)) departed.push_back(begin + i);
    }
    return departed;
}

void FrameFile::read_stored(std::size_t frame, std::uint64_t begin, std::uint64_t end,
                            Rows& rows) const {
    std::vector<double> numbers;
    std::string last;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const ColumnSource& source = state_->sources[k];
        if (source.dataset != last)
            numbers = read_block(state_->file.id(), source.dataset, {begin, end, frame},
                                 source.width);
        last = source.dataset;
        rows[k].resize(end - begin);
        for (std::uint64_t i = 0; i < end - begin; ++i)
            rows[k][i] = numbers[i * source.width + source.place];
    }
}

/// Reads rows of a checkpoint. Adding +0 turns -0 into +0, so that equal hashes give equal output.
void FrameFile::read_state(std::uint64_t begin, std::uint64_t end, Rows& rows) const {
    const CheckpointHeader& header = state_->header;
    const hid_t file = state_->file.id();
    const double clock = header.clock(), unit = static_cast<double>(header.micro_steps);
    DiscStates discs(end - begin, DiscState{});
    std::vector<std::uint64_t> bits(discs.size());
    for (const StateColumn& column : disc_columns) {
        const h5::Dataset dataset = h5::open_checked(file, path_of(column),
                                                     h5::Shape{header.n_discs});
        h5::read_rows(dataset.id(), {begin, end}, type_of(column), bits.data());
        for (std::size_t i = 0; i < discs.size(); ++i) column.set(discs[i], bits[i]);
    }
    for (auto& column : rows) column.clear();
    for (const DiscState& stored : discs) {
        const DiscState disc = header.frame.in_box(stored, clock);
        const std::array<double, 6> shown = {disc.x,
                                             disc.y,
                                             disc.vx * unit,
                                             disc.vy * unit,
                                             static_cast<double>(disc.pair_collisions),
                                             static_cast<double>(disc.wall_collisions)};
        for (std::size_t k = 0; k < shown.size(); ++k) rows[k].push_back(shown[k] + 0.0);
    }
    std::size_t k = 6;
    header.columns.for_each([&](SideColumn column) {
        std::vector<double>& numbers = rows[k++];
        numbers = read_block(file, path_of(column), {begin, end});
        for (double& number : numbers) number = number * (info_of(column).is_rate ? unit : 1) + 0.0;
    });
}

} // namespace carrom
