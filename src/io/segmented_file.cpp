// SPDX-License-Identifier: BSD-3-Clause
#include "io/segmented_file.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "io/checked_dataset.hpp"
#include "io/read_columns.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t least_room = std::uint64_t{1} << 20, most_room = std::uint64_t{4} << 30;

Width width_of(const RecordedColumn& column) { return {column.n_cells(), column.bytes_per_cell()}; }

std::vector<Width> widths_of(const std::vector<RecordedColumn>& columns) {
    std::vector<Width> widths;
    for (const RecordedColumn& column : columns) widths.push_back(width_of(column));
    return widths;
}

} // namespace

std::uint64_t RecordedColumn::bytes_per_cell() const {
    return H5Tget_size(type) * (row.size() > 1 ? row[1] : 1);
}

SegmentedFile::SegmentedFile(const std::string& path, std::vector<RecordedColumn> columns,
                             Build build)
    : path_(path), columns_(std::move(columns)), build_(std::move(build)) {}

std::string SegmentedFile::path_of(const Segment& segment) const {
    return (std::filesystem::path(folder_of(path_)) / segment.name).string();
}

void SegmentedFile::create() {
    segments_.clear();
    n_rows_ = 0;
    commit();
}

void SegmentedFile::go_on(const std::string& step, std::int64_t last,
                          const std::function<void(hid_t file)>& check) {
    check_segments(path_, false);
    const h5::File file = h5::open_file(path_, h5::Access::read);
    check(file.id());
    check_columns(file.id());
    segments_ = read_index(file.id(), path_).segments;
    n_rows_ = 0;
    for (const Segment& segment : segments_) n_rows_ += segment.rows;
    first_unsynced_ = 0;
    cut(count_up_to(file.id(), step, last));
}

void SegmentedFile::check_columns(hid_t file) const {
    const std::size_t n_columns = read_index(file, path_).widths.size();
    bool is_same = n_columns == columns_.size();
    for (const RecordedColumn& column : columns_) {
        if (!is_same || !h5::has(file, column.path)) {
            is_same = false;
            break;
        }
        const h5::Dataset dataset = h5::open_checked(file, column.path);
        const std::vector<hsize_t> sizes = h5::dimensions_of(dataset.id());
        const h5::Type type(h5::checked(H5Dget_type(dataset.id()), "cannot look at a dataset"));
        is_same = std::equal(sizes.begin() + 1, sizes.end(), column.row.begin(),
                             column.row.end()) &&
                  H5Tequal(type.id(), column.type) > 0;
    }
    if (!is_same) throw FileError("has other columns than this run records");
}

/// Leaves out segments beyond, and checks the one that is cut or written to next.
void SegmentedFile::cut(std::uint64_t n_rows) {
    const std::vector<Width> widths = widths_of(columns_);
    while (!segments_.empty() && n_rows_ - segments_.back().rows >= n_rows) {
        n_rows_ -= segments_.back().rows;
        segments_.pop_back();
    }
    if (segments_.empty()) return;
    Segment& segment = segments_.back();
    check_segment(folder_of(path_), segment, widths, true);
    segment.rows -= n_rows_ - n_rows;
    segment.numbers = hash_of_rows(Descriptor(path_of(segment), O_RDONLY | O_NOFOLLOW), segment,
                                   widths, 0, segment.rows);
    n_rows_ = n_rows;
}

/// Segments that the small file does not name are nobody's.
void SegmentedFile::remove_other_segments() const {
    for (std::size_t k = segments_.size() + 1;; ++k) {
        const auto path = std::filesystem::path(folder_of(path_)) / segment_name(path_, k);
        if (::unlink(path.c_str()) != 0) return;
    }
}

void SegmentedFile::make_segment() {
    std::uint64_t bytes_per_row = 0;
    for (const Width& width : widths_of(columns_)) bytes_per_row += width.bytes_per_row();
    const std::uint64_t wanted = std::clamp(n_rows_ * bytes_per_row, least_room, most_room);
    Segment segment;
    segment.name = segment_name(path_, segments_.size() + 1);
    segment.room = std::max<std::uint64_t>(1, wanted / bytes_per_row);
    const std::string path = path_of(segment);
    std::error_code error;
    std::filesystem::create_directories(folder_of(path), error);
    ::unlink(path.c_str()); // of a run that was killed
    const h5::Properties links = h5::properties(H5P_LINK_CREATE);
    h5::checked(H5Pset_create_intermediate_group(links.id(), 1), "cannot make groups");
    h5::File file = h5::create_new_file(path);
    try {
        for (const RecordedColumn& column : columns_) {
            std::vector<hsize_t> sizes = {segment.room};
            sizes.insert(sizes.end(), column.row.begin(), column.row.end());
            const h5::Properties creation = h5::dataset_creation();
            h5::checked(H5Pset_alloc_time(creation.id(), H5D_ALLOC_TIME_EARLY), "cannot allocate");
            h5::checked(H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER), "cannot allocate");
            const h5::Dataset dataset(h5::checked(
                H5Dcreate2(file.id(), column.path.c_str(), column.type, h5::space(sizes).id(),
                           links.id(), creation.id(), H5P_DEFAULT),
                column.path.c_str()));
            segment.places.push_back(H5Dget_offset(dataset.id()));
        }
        file.close("cannot be written");
    } catch (const FileError&) {
        file.abandon();
        throw;
    }
    segment.structure = hash_of_structure(Descriptor(path, O_RDONLY), segment, widths_of(columns_));
    segments_.push_back(std::move(segment));
}

std::uint64_t SegmentedFile::room() {
    if (segments_.empty() || segments_.back().rows == segments_.back().room) {
        open_.reset();
        make_segment();
    }
    return segments_.back().room - segments_.back().rows;
}

void SegmentedFile::write(std::size_t column, std::uint64_t begin, std::uint64_t count,
                          std::span<const std::byte> numbers) {
    const Segment& segment = segments_.back();
    if (!open_) open_ = std::make_unique<Descriptor>(path_of(segment), O_WRONLY | O_NOFOLLOW);
    const Width width = width_of(columns_[column]);
    const bool are_rows = columns_[column].row.empty();
    const std::uint64_t row = segment.rows + (are_rows ? begin : 0), cell = are_rows ? 0 : begin;
    open_->write(numbers, segment.places[column] + row * width.bytes_per_row() +
                              cell * width.bytes_per_cell);
    if (!are_rows) written_ += hash_of_part(column, row, cell, numbers);
    for (std::uint64_t i = 0; are_rows && i < count; ++i)
        written_ += hash_of_part(column, row + i, 0,
                                 numbers.subspan(i * width.bytes_per_cell, width.bytes_per_cell));
}

void SegmentedFile::add(std::uint64_t n_rows) {
    segments_.back().rows += n_rows;
    segments_.back().numbers += std::exchange(written_, {});
    n_rows_ += n_rows;
}

void SegmentedFile::close() {
    open_.reset();
    if (!failure_.empty()) throw FileError(std::exchange(failure_, {}));
}

void SegmentedFile::write_virtual(hid_t file, const RecordedColumn& column) const {
    std::vector<hsize_t> sizes = {n_rows_}, start(1 + column.row.size(), 0);
    sizes.insert(sizes.end(), column.row.begin(), column.row.end());
    const h5::Properties creation = h5::dataset_creation();
    const h5::Space whole = h5::space(sizes);
    std::vector<hsize_t> rows = sizes;
    for (const Segment& segment : segments_) {
        if (segment.rows == 0) continue;
        rows[0] = segment.rows;
        h5::checked(H5Sselect_hyperslab(whole.id(), H5S_SELECT_SET, start.data(), nullptr,
                                        rows.data(), nullptr),
                    "cannot choose rows");
        start[0] += segment.rows;
        sizes[0] = segment.room;
        const h5::Space source = h5::space(sizes);
        const std::vector<hsize_t> origin(sizes.size(), 0);
        h5::checked(H5Sselect_hyperslab(source.id(), H5S_SELECT_SET, origin.data(), nullptr,
                                        rows.data(), nullptr),
                    "cannot choose rows");
        h5::checked(H5Pset_virtual(creation.id(), whole.id(), segment.name.c_str(),
                                   column.path.c_str(), source.id()),
                    "cannot join segments");
    }
    // Where a segment is missing, readers shall not see zeros.
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    const std::int64_t none = -1;
    if (H5Tget_class(column.type) == H5T_FLOAT)
        h5::checked(H5Pset_fill_value(creation.id(), H5T_NATIVE_DOUBLE, &not_a_number), "no fill");
    else
        h5::checked(H5Pset_fill_value(creation.id(), H5T_NATIVE_INT64, &none), "no fill");
    h5::checked(H5Sselect_all(whole.id()), "cannot choose rows");
    h5::Dataset dataset(h5::checked(H5Dcreate2(file, column.path.c_str(), column.type, whole.id(),
                                               H5P_DEFAULT, creation.id(), H5P_DEFAULT),
                                    column.path.c_str()));
    dataset.close(column.path.c_str());
}

void SegmentedFile::write_index(hid_t file) const {
    build_(file, n_rows_);
    for (const RecordedColumn& column : columns_) write_virtual(file, column);
    carrom::write_index(file, {widths_of(columns_), segments_});
}

void SegmentedFile::commit() {
    for (; first_unsynced_ < segments_.size(); ++first_unsynced_)
        Descriptor(path_of(segments_[first_unsynced_]), O_WRONLY | O_NOFOLLOW).sync();
    if (!segments_.empty()) {
        --first_unsynced_; // more is written to the last one
        Descriptor(folder_of(path_of(segments_.back())), O_RDONLY | O_DIRECTORY).sync();
    }
    replace_file(path_, [this](const std::string& beside) {
        h5::File file = h5::create_new_file(beside);
        try {
            write_index(file.id());
            file.close("cannot be written");
        } catch (const FileError&) {
            file.abandon();
            throw;
        }
        seal_index(beside);
    });
    remove_other_segments();
}

} // namespace carrom
