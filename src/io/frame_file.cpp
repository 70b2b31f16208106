// SPDX-License-Identifier: BSD-3-Clause
#include "io/frame_file.hpp"

#include <algorithm>
#include <optional>

#include "io/checked_dataset.hpp"
#include "io/checkpoint_fields.hpp"
#include "io/child_process.hpp"
#include "io/files.hpp"
#include "io/h5md.hpp"
#include "io/segments.hpp"

namespace carrom {

/// Where a column's numbers are: component `place` of `width` numbers in each row of a data set.
struct ColumnSource {
    std::string column, dataset;
    hsize_t width = 1, place = 0;
};

namespace {

constexpr std::size_t longest_word = 1000;
constexpr const char *discs_path = "/particles/discs/", *log_path = "/carrom/collisions/";

/// In the order of FileSummary::columns.
std::vector<ColumnSource> sources_of_frames() {
    std::vector<ColumnSource> sources = {{"x", "position", 3, 0},
                                         {"y", "position", 3, 1},
                                         {"vx", "velocity", 3, 0},
                                         {"vy", "velocity", 3, 1},
                                         {"pair_collisions", "collisions", 2, 1},
                                         {"wall_collisions", "collisions", 2, 0},
                                         {"psi6_real", "psi6", 2, 0},
                                         {"psi6_imaginary", "psi6", 2, 1},
                                         {"neighbours", "neighbours", 1, 0},
                                         {"image_x", "image", 3, 0},
                                         {"image_y", "image", 3, 1}};
    for (const SideColumnInfo& info : side_column_table)
        sources.push_back({info.shown, info.shown, 1, 0});
    for (ColumnSource& source : sources) source.dataset = discs_path + source.dataset + "/value";
    return sources;
}

std::vector<ColumnSource> sources_of_logs() {
    std::vector<ColumnSource> sources;
    for (const char* name : {"step", "time", "p", "q", "impulse"})
        sources.push_back({name, std::string(log_path) + name});
    return sources;
}

/// Rows [begin, end) of a frame, as doubles; of a data set with one axis `frame` must be 0.
void read_block(hid_t file, const ColumnSource& source, std::size_t frame, std::uint64_t begin,
                std::uint64_t end, std::vector<double>& numbers) {
    const std::string& path = source.dataset;
    const h5::Dataset dataset = h5::open_checked(file, path);
    std::vector<hsize_t> count = h5::dimensions_of(dataset.id()), start(count.size(), 0);
    if (count.empty() || count.size() > 3 || (count.size() == 3 ? count[2] : 1) != source.width)
        throw FileError(path + " has another shape than this program writes");
    const std::size_t axis = count.size() == 1 ? 0 : 1;
    if (end > count[axis] || (axis == 1 && frame >= count[0]))
        throw FileError(path + " is shorter than the others");
    if (axis == 1) start[0] = frame, count[0] = 1;
    start[axis] = begin;
    count[axis] = end - begin;
    numbers.resize((end - begin) * source.width);
    const h5::Space place(h5::checked(H5Dget_space(dataset.id()), path.c_str())),
        memory = h5::space(count);
    h5::checked(H5Sselect_hyperslab(place.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                                    nullptr),
                path.c_str());
    h5::checked(H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, memory.id(), place.id(), H5P_DEFAULT,
                        numbers.data()),
                path.c_str());
}

/// The words of an attribute, each as long as the others, side by side.
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

/// What all files say of the discs' system.
void read_system(hid_t file, std::uint64_t n_discs, FileSummary& summary) {
    summary.program_version = letters_of(file, "/h5md/creator", "version", 1);
    h5::read_scalar(file, "/parameters/radius", summary.radius);
    if (n_discs > 0) summary.species = read_species(file, h5md::shown_species_path, n_discs);
    const std::string boundary = letters_of(file, "/particles/discs/box", "boundary", 3);
    summary.is_periodic_x = boundary.starts_with("periodic");
    summary.is_periodic_y = boundary.substr(boundary.size() / 3).starts_with("periodic");
    std::vector<double> open(4, 0);
    if (h5::has(file, "/parameters/open_sides"))
        read_block(file, {"", "/parameters/open_sides"}, 0, 0, 4, open);
    for (std::size_t side = 0; side < open.size(); ++side)
        summary.open_boundaries[side] = open[side] != 0;
    if (!h5::has(file, "/parameters/wall_amplitudes")) return;
    read_block(file, {"", "/parameters/wall_amplitudes"}, 0, 0, 4, open);
    std::copy(open.begin(), open.end(), summary.amplitudes.begin());
}

template <class Act> void with_path(const std::string& path, const Act& act) {
    try {
        act();
    } catch (const FileError& error) {
        throw InputError({{path, 0, error.what()}});
    }
}

} // namespace

std::size_t FileSummary::place_of(std::string_view column) const {
    return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), column) -
                                    columns.begin());
}

struct FrameFile::State {
    h5::File file;
    CheckpointHeader header;           ///< of a checkpoint
    std::vector<ColumnSource> sources; ///< of a recording's columns
    std::vector<FileSegment> segments; ///< of a recording
};

FrameFile::FrameFile(const std::string& path) : path_(path), state_(std::make_unique<State>()) {
    with_path(path_, [&] {
        try_in_child([&] {
            open();
            try_all_parts();
        });
        open();
    });
}

FrameFile::~FrameFile() = default;
FrameFile::FrameFile(FrameFile&&) noexcept = default;

void FrameFile::open() {
    summary_ = {};
    const bool has_segments = joins_segments(path_);
    if (has_segments) state_->segments = check_segments(path_, false).segments;
    state_->file = h5::open_file(path_, h5::Access::read);
    const hid_t file = state_->file.id();
    if (!has_segments && h5::has(file, "/carrom/recording"))
        throw FileError("is damaged: it does not end with a checksum, as this program writes it");
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
        for (const ColumnSource& source : state_->sources = sources_of_logs())
            summary_.columns.push_back(source.column);
        summary_.n_rows = h5::length_of(file, state_->sources.front().dataset);
    } else if (h5::has(file, "/particles/discs")) {
        open_trajectory();
    } else {
        throw FileError("holds nothing that carrom writes");
    }
    read_system(file, summary_.kind == FileKind::collisions ? 0 : summary_.n_rows, summary_);
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
        const h5::Type type(h5::checked(H5Dget_type(values.id()), source.dataset.c_str()));
        summary_.n_rows = h5::n_rows_of(values.id());
        if (H5Tget_class(type.id()) == H5T_FLOAT)
            summary_.bytes_per_number = H5Tget_size(type.id());
        summary_.columns.push_back(source.column);
        state_->sources.push_back(source);
    }
    if (summary_.steps.empty()) return;
    std::vector<double> edges;
    read_block(file, {"", h5md::edges_path}, summary_.steps.size() - 1, 0, 3, edges);
    summary_.box = {edges[0], edges[1]};
}

/// The first row of each segment, or of a checkpoint.
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

void FrameFile::check_numbers() const {
    with_path(path_, [&] {
        if (joins_segments(path_)) check_segments(path_, true);
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

void FrameFile::read_stored(std::size_t frame, std::uint64_t begin, std::uint64_t end,
                            Rows& rows) const {
    std::vector<double> numbers;
    std::string last;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const ColumnSource& source = state_->sources[k];
        if (source.dataset != last)
            read_block(state_->file.id(), source, frame, begin, end, numbers);
        last = source.dataset;
        rows[k].resize(end - begin);
        for (std::uint64_t i = 0; i < end - begin; ++i)
            rows[k][i] = numbers[i * source.width + source.place];
    }
}

/// Adding +0 turns -0 into +0: two states of the same hash show the same.
void FrameFile::read_state(std::uint64_t begin, std::uint64_t end, Rows& rows) const {
    const CheckpointHeader& header = state_->header;
    const hid_t file = state_->file.id();
    const double clock = header.clock(), unit = static_cast<double>(header.micro_steps);
    std::vector<Disc> discs(end - begin);
    std::vector<std::uint64_t> bits(discs.size());
    for (const StateColumn& column : disc_columns) {
        const h5::Dataset dataset = h5::open_checked(file, path_of(column), {header.n_discs});
        h5::read_rows(dataset.id(), {begin, end}, type_of(column), bits.data());
        for (std::size_t i = 0; i < discs.size(); ++i) column.set(discs[i], bits[i]);
    }
    for (auto& column : rows) column.clear();
    for (const Disc& stored : discs) {
        const Disc disc = header.frame.in_box(stored, clock);
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
        read_block(file, {"", path_of(column)}, 0, begin, end, numbers);
        for (double& number : numbers) number = number * (info_of(column).is_rate ? unit : 1) + 0.0;
    });
}

} // namespace carrom
