// SPDX-License-Identifier: BSD-3-Clause
#include "io/frame_file.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "io/checked_dataset.hpp"
#include "io/checkpoint_fields.hpp"
#include "io/crash_guard.hpp"
#include "io/files.hpp"
#include "io/read_columns.hpp"
#include "io/segments.hpp"

namespace carrom {

namespace {

constexpr std::size_t longest_word = 1000;

/// Rows [begin, end) of a column, or, of `width` numbers each, of frame `frame` of a dataset with
/// several axes.
void read_block(hid_t file, const std::string& path, std::size_t frame, std::uint64_t begin,
                std::uint64_t end, hsize_t width, hid_t type, void* values) {
    const h5::Dataset dataset = h5::open_checked(file, path);
    std::vector<hsize_t> count = h5::dimensions_of(dataset.id()), start(count.size(), 0);
    if (count.empty() || (count.size() == 3 ? count[2] : 1) != width)
        throw FileError(path + " has another shape than this program writes");
    const std::size_t axis = count.size() == 1 ? 0 : 1;
    if (end > count[axis] || (axis == 1 && frame >= count[0]))
        throw FileError(path + " is shorter than the others");
    if (axis == 1) start[0] = frame;
    if (axis == 1) count[0] = 1;
    start[axis] = begin;
    count[axis] = end - begin;
    const h5::Space source(h5::checked(H5Dget_space(dataset.id()), path.c_str())),
        memory = h5::space(count);
    h5::checked(H5Sselect_hyperslab(source.id(), H5S_SELECT_SET, start.data(), nullptr,
                                    count.data(), nullptr),
                path.c_str());
    h5::checked(H5Dread(dataset.id(), type, memory.id(), source.id(), H5P_DEFAULT, values),
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

template <class Act> void guarded(const std::string& path, const Act& act) {
    try {
        const CrashGuard guard(path);
        act();
    } catch (const FileError& error) {
        throw InputError({{path, 0, error.what()}});
    }
}

/// What `/particles/discs` has of one frame after the other.
struct Element {
    const char* name;
    hsize_t width; ///< numbers for a disc
};
constexpr std::array<Element, 4> elements = {
    {{"position", 3}, {"velocity", 3}, {"collisions", 2}, {"angular_velocity", 1}}};

constexpr const char* discs_path = "/particles/discs/";

FileSummary summary_of_checkpoint(hid_t file, CheckpointHeader& header) {
    const h5::Group run(
        h5::checked(H5Gopen2(file, "/carrom/run", H5P_DEFAULT), "has no /carrom/run"));
    header = read_header(run.id());
    header.has_spins = has_spins(file);
    return {FileKind::checkpoint,
            header.program_version,
            header.n_discs,
            header.box_size,
            header.radius,
            8,
            true,
            true,
            true,
            header.has_spins,
            {header.step},
            0,
            header.state_hash};
}

FileSummary summary_of_trajectory(hid_t file) {
    const std::string discs = discs_path;
    FileSummary summary;
    summary.kind = FileKind::trajectory;
    summary.has_position = h5::has(file, "/particles/discs/position");
    summary.has_velocity = h5::has(file, "/particles/discs/velocity");
    summary.has_collisions = h5::has(file, "/particles/discs/collisions");
    summary.has_angular_velocity = h5::has(file, "/particles/discs/angular_velocity");
    summary.steps = read_numbers(file, "/particles/discs/box/edges/step");
    for (const Element& element : elements) {
        if (!h5::has(file, discs + element.name)) continue;
        h5::Shape shape = {std::nullopt, std::nullopt};
        if (element.width > 1) shape.push_back(element.width);
        const h5::Dataset values = h5::open_checked(file, discs + element.name + "/value", shape);
        const h5::Type type(h5::checked(H5Dget_type(values.id()), element.name));
        summary.n_discs = h5::dimensions_of(values.id())[1];
        if (element.width != 2) summary.bytes_per_number = H5Tget_size(type.id());
    }
    h5::read_scalar(file, "/parameters/radius", summary.radius);
    const std::string boundary = letters_of(file, "/particles/discs/box", "boundary", 3),
                      periodic = "periodic";
    summary.is_periodic_x = boundary.compare(0, periodic.size(), periodic) == 0;
    summary.is_periodic_y = boundary.compare(boundary.size() / 3, periodic.size(), periodic) == 0;
    std::array<std::int32_t, 4> open_boundaries{};
    if (h5::has(file, "/parameters/open_sides"))
        read_block(file, "/parameters/open_sides", 0, 0, 4, 1, H5T_NATIVE_INT32,
                   open_boundaries.data());
    for (std::size_t side = 0; side < open_boundaries.size(); ++side)
        summary.open_boundaries[side] = open_boundaries[side] != 0;
    std::array<double, 3> edges = {};
    if (!summary.steps.empty())
        read_block(file, discs + "box/edges/value", 0, 0, 3, 1, H5T_NATIVE_DOUBLE, edges.data());
    summary.box_size = edges[0];
    return summary;
}

} // namespace

struct FrameFile::State {
    h5::File file;
    CheckpointHeader header; ///< of a checkpoint
};

FrameFile::FrameFile(const std::string& path) : path_(path), state_(std::make_unique<State>()) {
    guarded(path_, [&] {
        const bool has_segments = joins_segments(path_);
        if (has_segments) check_segments(path_, false);
        h5::File opened = h5::open_file(
            path_, h5::Access::read); // closed in here if anything is thrown: closing may crash too
        const hid_t file = opened.id();
        if (!has_segments && h5::has(file, "/carrom/recording"))
            throw FileError(
                "is damaged: it does not end with a checksum, as this program writes it");
        if (h5::has(file, "/carrom/run")) {
            summary_ = summary_of_checkpoint(file, state_->header);
        } else if (h5::has(file, "/carrom/collisions")) {
            summary_.kind = FileKind::collisions;
            summary_.n_logged = length_of(file, "/carrom/collisions/step");
        } else if (h5::has(file, "/particles/discs")) {
            summary_ = summary_of_trajectory(file);
        } else {
            throw FileError("holds nothing that carrom writes");
        }
        if (summary_.kind != FileKind::checkpoint)
            summary_.program_version = letters_of(file, "/h5md/creator", "version", 1);
        state_->file = std::move(opened);
    });
}

FrameFile::~FrameFile() {
    const CrashGuard guard(path_);
    state_.reset();
}
FrameFile::FrameFile(FrameFile&&) noexcept = default;

void FrameFile::check_numbers() const {
    guarded(path_, [&] {
        if (joins_segments(path_)) check_segments(path_, true);
    });
}

void FrameFile::read(std::size_t frame, std::uint64_t begin, std::uint64_t end,
                     std::vector<FrameRow>& rows) const {
    const hid_t file = state_->file.id();
    const std::uint64_t n = end - begin;
    rows.assign(n, {});
    guarded(path_, [&] {
        if (summary_.kind == FileKind::checkpoint) {
            std::vector<Disc> discs(n);
            std::vector<std::uint64_t> numbers(n);
            for (const DiscColumn& column : disc_columns) {
                read_block(file, std::string("/carrom/discs/") + column.name, 0, begin, end, 1,
                           type_of(column), numbers.data());
                for (std::uint64_t i = 0; i < n; ++i) column.set(discs[i], numbers[i]);
            }
            const double clock = state_->header.clock(),
                         k = static_cast<double>(state_->header.micro_steps);
            for (std::uint64_t i = 0; i < n; ++i) {
                const Disc disc = state_->header.frame.in_box(discs[i], clock);
                rows[i] = {disc.x + 0.0,
                           disc.y + 0.0,
                           disc.vx * k + 0.0,
                           disc.vy * k + 0.0,
                           disc.wall_collisions,
                           disc.pair_collisions,
                           0};
            }
            if (!summary_.has_angular_velocity) return;
            std::vector<double> spins(n);
            read_block(file, spin_column, 0, begin, end, 1, H5T_NATIVE_DOUBLE, spins.data());
            for (std::uint64_t i = 0; i < n; ++i) rows[i].angular_velocity = spins[i] * k + 0.0;
            return;
        }
        const std::string discs = discs_path;
        std::vector<double> vectors(3 * n);
        std::vector<std::uint64_t> counts(2 * n);
        if (summary_.has_position)
            read_block(file, discs + "position/value", frame, begin, end, 3, H5T_NATIVE_DOUBLE,
                       vectors.data());
        for (std::uint64_t i = 0; i < n && summary_.has_position; ++i)
            rows[i].x = vectors[3 * i], rows[i].y = vectors[3 * i + 1];
        if (summary_.has_velocity)
            read_block(file, discs + "velocity/value", frame, begin, end, 3, H5T_NATIVE_DOUBLE,
                       vectors.data());
        for (std::uint64_t i = 0; i < n && summary_.has_velocity; ++i)
            rows[i].vx = vectors[3 * i], rows[i].vy = vectors[3 * i + 1];
        if (summary_.has_collisions)
            read_block(file, discs + "collisions/value", frame, begin, end, 2, H5T_NATIVE_UINT64,
                       counts.data());
        for (std::uint64_t i = 0; i < n && summary_.has_collisions; ++i)
            rows[i].wall_collisions = counts[2 * i], rows[i].pair_collisions = counts[2 * i + 1];
        if (summary_.has_angular_velocity)
            read_block(file, discs + "angular_velocity/value", frame, begin, end, 1,
                       H5T_NATIVE_DOUBLE, vectors.data());
        for (std::uint64_t i = 0; i < n && summary_.has_angular_velocity; ++i)
            rows[i].angular_velocity = vectors[i];
    });
}

void FrameFile::read(std::uint64_t begin, std::uint64_t end,
                     std::vector<LoggedCollision>& rows) const {
    const hid_t file = state_->file.id();
    rows.assign(end - begin, {});
    const auto column = [&](const char* name, hid_t type, auto field) {
        using Number = std::remove_reference_t<decltype(rows[0].*field)>;
        std::vector<Number> numbers(end - begin);
        read_block(file, std::string("/carrom/collisions/") + name, 0, begin, end, 1, type,
                   numbers.data());
        for (std::size_t i = 0; i < rows.size(); ++i) rows[i].*field = numbers[i];
    };
    guarded(path_, [&] {
        column("step", H5T_NATIVE_INT64, &LoggedCollision::step);
        column("time", H5T_NATIVE_DOUBLE, &LoggedCollision::time);
        column("p", H5T_NATIVE_INT64, &LoggedCollision::p);
        column("q", H5T_NATIVE_INT64, &LoggedCollision::q);
        column("impulse", H5T_NATIVE_DOUBLE, &LoggedCollision::impulse);
    });
}

} // namespace carrom
