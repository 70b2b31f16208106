// SPDX-License-Identifier: BSD-3-Clause
#include "io/segmented_file.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "io/checked_dataset.hpp"
#include "io/child_process.hpp"
#include "io/h5md.hpp"
#include "io/seal.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t least_room = std::uint64_t{1} << 20, most_room = std::uint64_t{4} << 30;

std::vector<hsize_t> sizes_of(const RecordedColumn& column, std::uint64_t n_rows) {
    std::vector<hsize_t> sizes = {n_rows};
    sizes.insert(sizes.end(), column.row.begin(), column.row.end());
    return sizes;
}

Index index_of(const std::string& path, bool are_rows_wanted) {
    std::optional<Index> index = read_checked_index(path, are_rows_wanted);
    if (!index) throw FileError("does not end as a recording of this program does");
    return std::move(*index);
}

/// A data space of these dimensions, in which `n_rows` rows from row `first` on are selected.
h5::Space rows_of(const std::vector<hsize_t>& sizes, std::uint64_t first, std::uint64_t n_rows) {
    h5::Space space = h5::space(sizes);
    std::vector<hsize_t> start(sizes.size(), 0), count = sizes;
    start[0] = first;
    count[0] = n_rows;
    h5::select(space, start, count);
    return space;
}

} // namespace

SegmentedFile::SegmentedFile(const std::string& path, std::vector<RecordedColumn> columns,
                             Build build, const Communicator& communicator)
    : path_(path), columns_(std::move(columns)), build_(std::move(build)),
      communicator_(communicator), written_(columns_.size(), 0) {
    for (const RecordedColumn& column : columns_) {
        std::uint64_t bytes = H5Tget_size(column.type);
        for (const hsize_t n : column.row) bytes *= n;
        index_.row_bytes.push_back(bytes);
    }
}

void SegmentedFile::begin() {
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        check_room(folder_of(path_), least_room);
        index_.segments.clear();
        open_.reset();
        seal_.reset();
        n_rows_ = 0;
        commit_here();
    });
}

bool SegmentedFile::go_on(const std::string& step, std::int64_t last,
                          const std::function<void(hid_t file)>& check) {
    std::uint64_t is_there = 0;
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        std::error_code error;
        is_there = std::filesystem::exists(path_, error) ? 1 : 0;
        if (error) throw FileError("cannot be found: " + error.message());
    });
    communicator_.broadcast(is_there);
    if (is_there == 0) {
        on_root(communicator_, path_, ExitCode::bad_input, [&] { refuse_segments(); });
        on_root(communicator_, path_, ExitCode::output_failure,
                [&] { check_room(folder_of(path_), least_room); });
        return false;
    }
    on_root(communicator_, path_, ExitCode::bad_input, [&] { take_over(step, last, check); });
    return true;
}

/// Throws if there is a segment without a joining file, because it may be part of a recording.
void SegmentedFile::refuse_segments() const {
    const std::string name = segment_name(path_, 1);
    std::error_code error;
    if (std::filesystem::exists(segment_path(path_, name), error))
        throw FileError("is not there, and its segment " + name +
                        " is; bring it back, or move its segments away");
}

void SegmentedFile::take_over(const std::string& step, std::int64_t last,
                              const std::function<void(hid_t file)>& check) {
    std::uint64_t n_rows = 0;
    inspect_in_child_first([&] {
        const Index index = index_of(path_, false);
        const h5::File file = h5::open_file(path_, h5::Access::read);
        check(file.id());
        check_columns(file.id(), index);
        n_rows = h5::count_up_to(file.id(), step, last);
    });
    index_ = index_of(path_, true);
    seal_ = seal_of(path_);
    n_rows_ = 0;
    for (const FileSegment& segment : index_.segments) n_rows_ += segment.rows;
    cut(n_rows);
}

void SegmentedFile::check_columns(hid_t file, const Index& index) const {
    bool is_same = index.row_bytes == index_.row_bytes;
    for (const RecordedColumn& column : columns_) {
        is_same = is_same && h5::has(file, column.path);
        if (!is_same) break;
        const h5::Dataset dataset = h5::open_checked(file, column.path);
        const std::vector<hsize_t> sizes = h5::dimensions_of(dataset.id());
        is_same = !sizes.empty() && sizes == sizes_of(column, sizes[0]) &&
                  H5Tequal(h5::stored_type(dataset.id()).id(), column.type) > 0;
    }
    if (!is_same)
        throw FileError("has other columns than this run records; see output.trajectory.fields");
}

/// Keeps the first `n_rows` rows. The next rows are written to the last remaining segment.
void SegmentedFile::cut(std::uint64_t n_rows) {
    is_cut_ = n_rows < n_rows_;
    std::vector<FileSegment>& segments = index_.segments;
    while (!segments.empty() && n_rows_ - segments.back().rows >= n_rows) {
        n_rows_ -= segments.back().rows;
        segments.pop_back();
    }
    if (segments.empty()) return;
    FileSegment& segment = segments.back();
    segment.rows -= n_rows_ - n_rows;
    hashers_ = hash_rows(segment_path(path_, segment.name), segment, index_.row_bytes);
    segment.numbers = sum_of(hashers_);
    n_rows_ = n_rows;
    open_segment();
}

void SegmentedFile::open_segment() {
    open_ = std::make_unique<Descriptor>(segment_path(path_, segments().back().name),
                                         O_WRONLY | O_NOFOLLOW);
    open_size_ = open_->size();
}

void SegmentedFile::make_segment() {
    std::uint64_t bytes_per_row = 0;
    for (const std::uint64_t bytes : index_.row_bytes) bytes_per_row += bytes;
    const std::uint64_t wanted = std::clamp(n_rows_ * bytes_per_row, least_room, most_room);
    FileSegment segment;
    segment.name = segment_name(path_, index_.segments.size() + 1);
    segment.room = std::max<std::uint64_t>(1, wanted / bytes_per_row);
    const std::string path = segment_path(path_, segment.name);
    std::error_code error;
    std::filesystem::create_directory(folder_of(path), error); // the run's folder must exist
    ::unlink(path.c_str());                                    // removes a file of a killed run
    h5::create_file(path, [&](hid_t file) {
        for (const RecordedColumn& column : columns_) {
            const h5::Dataset dataset = h5::create_dataset(file, column.path, column.type,
                                                           sizes_of(column, segment.room),
                                                           h5::allocated_creation());
            segment.places.push_back(H5Dget_offset(dataset.id()));
        }
    });
    segment.structure = hash_of_structure(path, segment, index_.row_bytes);
    hashers_ = hashers_of_columns(columns_.size());
    index_.segments.push_back(std::move(segment));
    open_segment();
}

std::uint64_t SegmentedFile::room() {
    ensure(!is_cut_, "a recording that was cut back is committed before rows are added");
    if (segments().empty() || segments().back().rows == segments().back().room) {
        sync_segment();
        make_segment();
    }
    return segments().back().room - segments().back().rows;
}

void SegmentedFile::write(std::size_t column, std::span<const std::byte> numbers) {
    const FileSegment& segment = segments().back();
    open_->write(numbers, segment.places[column] + segment.rows * index_.row_bytes[column] +
                              written_[column]);
    hashers_[column].add(numbers);
    written_[column] += numbers.size();
}

void SegmentedFile::add(std::uint64_t n_rows) {
    for (std::size_t k = 0; k < written_.size(); ++k)
        ensure(std::exchange(written_[k], 0) == n_rows * index_.row_bytes[k],
               "a column of a recording has other rows than the others");
    FileSegment& segment = index_.segments.back();
    segment.rows += n_rows;
    segment.numbers = sum_of(hashers_);
    n_rows_ += n_rows;
}

void SegmentedFile::finish_addition() {
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        if (!failure_.empty()) throw FileError(std::exchange(failure_, {}));
    });
}

void SegmentedFile::write_virtual(hid_t file, const RecordedColumn& column) const {
    const h5::Properties creation = h5::dataset_creation();
    const std::vector<hsize_t> sizes = sizes_of(column, n_rows_);
    std::uint64_t first = 0;
    for (const FileSegment& segment : segments()) {
        if (segment.rows == 0) continue;
        h5::checked(H5Pset_virtual(creation.id(), rows_of(sizes, first, segment.rows).id(),
                                   segment.name.c_str(), column.path.c_str(),
                                   rows_of(sizes_of(column, segment.room), 0, segment.rows).id()),
                    "cannot join segments");
        first += segment.rows;
    }
    // The fill value is NaN, or -1 for integers, so that readers do not get zeros if a segment is
    // missing.
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    const std::int64_t none = -1;
    if (H5Tget_class(column.type) == H5T_FLOAT)
        h5::set(creation, H5Pset_fill_value, H5T_NATIVE_DOUBLE, &not_a_number);
    else
        h5::set(creation, H5Pset_fill_value, H5T_NATIVE_INT64, &none);
    h5::Dataset dataset = h5::create_dataset(file, column.path, column.type, sizes, creation);
    h5md::write_unit(dataset.id(), column.unit);
    dataset.close(column.path);
}

void SegmentedFile::commit() {
    on_root(communicator_, path_, ExitCode::output_failure, [&] { commit_here(); });
}

/// Syncs the last segment and its entry in the folder; earlier segments are already on disk.
void SegmentedFile::sync_segment() const {
    if (segments().empty()) return;
    const std::string path = segment_path(path_, segments().back().name);
    if (!leads_to(path, open_->number()) || open_->size() != open_size_)
        throw FileError(fmt::format("its part {} was moved, removed, replaced or cut short while "
                                    "the run wrote there; bring it back, then go on by --resume",
                                    segments().back().name));
    open_->sync();
    Descriptor(folder_of(path), O_RDONLY | O_DIRECTORY).sync();
}

/// Throws if another program has replaced the small file, because a commit would replace that file.
void SegmentedFile::refuse_other_file() const {
    std::error_code error;
    const auto is_there = [&] { return std::filesystem::exists(path_, error); };
    if (!seal_ || !is_there()) return;
    try {
        if (seal_of(path_) == seal_) return;
    } catch (const FileError&) { // another process may be removing the file and its folder
        if (!is_there()) return;
        throw;
    }
    throw FileError("was replaced by another file while the run wrote there; move that away, "
                    "then go on by --resume");
}

void SegmentedFile::commit_here() {
    sync_segment();
    replace_file(path_, [this](const std::string& beside) {
        h5::create_file(beside, [this](hid_t file) {
            build_(file);
            for (const RecordedColumn& column : columns_) write_virtual(file, column);
            write_index(file, index_);
        });
        seal_index(beside);
        const auto seal = seal_of(beside);
        refuse_other_file(); // repeated here, because another file may appear at any time
        seal_ = seal;
    });
    is_cut_ = false;
    // Removes segments that the small file does not list, because they belong to no recording.
    for (std::size_t k = segments().size() + 1;; ++k)
        if (::unlink(segment_path(path_, segment_name(path_, k)).c_str()) != 0) return;
}

} // namespace carrom
