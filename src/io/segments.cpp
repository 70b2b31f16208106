// SPDX-License-Identifier: BSD-3-Clause
#include "io/segments.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "io/checked_dataset.hpp"
#include "io/files.hpp"
#include "io/seal.hpp"

namespace carrom {

namespace {

constexpr const char *columns_path = "/carrom/recording/columns",
                     *segments_path = "/carrom/recording/segments";
constexpr std::uint64_t largest_column = std::uint64_t{1} << 60;
constexpr std::size_t n_fixed = 6; ///< numbers in the entry of a segment before its column offsets

Index read_index(hid_t file, const std::string& path) {
    Index index{h5::read_column<std::uint64_t>(file, columns_path), {}};
    const auto numbers = h5::read_column<std::uint64_t>(file, segments_path);
    const std::size_t n = n_fixed + index.row_bytes.size();
    bool is_sound = !index.row_bytes.empty() && numbers.size() % n == 0;
    for (std::size_t k = 0; is_sound && k < numbers.size() / n; ++k) {
        const auto row = std::span(numbers).subspan(k * n, n);
        index.segments.push_back({segment_name(path, k + 1),
                                  row[0],
                                  row[1],
                                  {row[2], row[3]},
                                  {row[4], row[5]},
                                  {row.begin() + n_fixed, row.end()}});
        for (const std::uint64_t bytes : index.row_bytes)
            is_sound = is_sound && bytes > 0 && row[0] <= row[1] &&
                       row[1] <= largest_column / bytes;
    }
    if (!is_sound) throw FileError("its list of segments is not one that this program writes");
    return index;
}

} // namespace

std::string segment_name(const std::string& path, std::size_t number) {
    return fmt::format("{}/{:04}.h5", std::filesystem::path(path).stem().string(), number);
}

std::string segment_path(const std::string& joining, const std::string& name) {
    return (std::filesystem::path(folder_of(joining)) / name).string();
}

/// The hash of a column begins with the column's number, so swapped columns change the checksum.
ColumnHashers hashers_of_columns(std::size_t n_columns) {
    ColumnHashers hashers(n_columns);
    for (std::size_t k = 0; k < n_columns; ++k) hashers[k].add(std::as_bytes(std::span(&k, 1)));
    return hashers;
}

StateHash sum_of(const ColumnHashers& hashers) {
    StateHash sum;
    for (const Hasher& hasher : hashers) sum += hasher.digest();
    return sum;
}

ColumnHashers hash_rows(const std::string& path, const FileSegment& segment,
                        const std::vector<std::uint64_t>& row_bytes) {
    ColumnHashers hashers = hashers_of_columns(row_bytes.size());
    for (std::size_t k = 0; k < row_bytes.size(); ++k)
        hashers[k].add_bytes_of(
            path, {segment.places[k], segment.places[k] + segment.rows * row_bytes[k]});
    return hashers;
}

StateHash hash_of_structure(const std::string& path, const FileSegment& segment,
                            const std::vector<std::uint64_t>& row_bytes) {
    std::vector<ByteRange> columns;
    for (std::size_t k = 0; k < row_bytes.size(); ++k)
        columns.push_back({segment.places[k], segment.places[k] + segment.room * row_bytes[k]});
    return checksum_of_others(path, columns);
}

void write_index(hid_t file, const Index& index) {
    std::vector<std::uint64_t> numbers;
    for (const FileSegment& one : index.segments) {
        numbers.insert(numbers.end(), {one.rows, one.room, one.numbers.low, one.numbers.high,
                                       one.structure.low, one.structure.high});
        numbers.insert(numbers.end(), one.places.begin(), one.places.end());
    }
    static_cast<void>(h5::create_group(file, "/carrom/recording"));
    h5::write_column(file, columns_path, index.row_bytes);
    h5::write_column(file, segments_path, numbers);
}

std::optional<Index> read_checked_index(const std::string& path, bool are_rows_wanted) {
    if (!check_seal(path)) return std::nullopt;
    Index index = read_index(h5::open_alone(path, h5::Access::read).id(), path);
    require_free_files(index.segments.size());
    for (const FileSegment& segment : index.segments) {
        try {
            const std::string part = segment_path(path, segment.name);
            std::error_code error; // ignored: opening an inaccessible part reports the error
            if (!std::filesystem::exists(part, error) && !error)
                throw FileError(fmt::format("is not there; copy the folder {}/ together with {}",
                                            folder_of(segment.name),
                                            std::filesystem::path(path).filename().string()));
            if (hash_of_structure(part, segment, index.row_bytes) != segment.structure)
                throw FileError("its structure is damaged");
            if (are_rows_wanted &&
                sum_of(hash_rows(part, segment, index.row_bytes)) != segment.numbers)
                throw FileError("its numbers are damaged");
        } catch (const FileError& error) {
            throw FileError(fmt::format("its part {}: {}", segment.name, error.what()));
        }
    }
    return index;
}

} // namespace carrom
