// SPDX-License-Identifier: BSD-3-Clause
#include "io/segments.hpp"

#include <cstring>
#include <filesystem>
#include <string_view>

#include <fcntl.h>

#include <fmt/format.h>

#include "io/checked_dataset.hpp"
#include "io/files.hpp"

namespace carrom {

namespace {

constexpr std::string_view mark = "carrom, checked:"; // then a checksum of 16 bytes: the file's end
constexpr std::size_t end_size = mark.size() + sizeof(StateHash);
constexpr const char *columns_path = "/carrom/recording/columns",
                     *segments_path = "/carrom/recording/segments";
constexpr std::uint64_t largest_column = std::uint64_t{1} << 60;
constexpr std::size_t n_fixed = 6; ///< a segment's numbers before the places of its columns

StateHash hash_of(std::span<const std::byte> bytes) {
    Hasher hasher;
    hasher.add(bytes);
    return hasher.digest();
}

std::vector<std::byte> read_end(const Descriptor& file, std::uint64_t begin) {
    std::vector<std::byte> bytes(file.size() - begin);
    if (file.read(bytes, begin) < bytes.size()) throw FileError("is cut short");
    return bytes;
}

/// The mark and the checksum; nothing if the file does not end as an index does.
std::vector<std::byte> end_of_index(const Descriptor& file) {
    if (file.size() < end_size) return {};
    std::vector<std::byte> end = read_end(file, file.size() - end_size);
    if (std::memcmp(end.data(), mark.data(), mark.size()) != 0) return {};
    return end;
}

/// Returns the file's bytes if they end as an index does.
std::vector<std::byte> bytes_of_index(const std::string& path) {
    const Descriptor file(path, O_RDONLY);
    return end_of_index(file).empty() ? std::vector<std::byte>{} : read_end(file, 0);
}

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

/// The first bytes to hash differ from column to column.
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

void seal_index(const std::string& path) {
    const Descriptor file(path, O_RDWR);
    std::vector<std::byte> bytes = read_end(file, 0);
    const std::size_t size = bytes.size();
    bytes.resize(size + end_size);
    std::memcpy(bytes.data() + size, mark.data(), mark.size());
    const StateHash hash = hash_of(std::span(bytes).first(size + mark.size()));
    std::memcpy(bytes.data() + size + mark.size(), &hash, sizeof hash);
    file.write(std::span(bytes).subspan(size), size);
    file.sync();
}

std::optional<StateHash> seal_of(const std::string& path) {
    const std::vector<std::byte> end = end_of_index(Descriptor(path, O_RDONLY));
    if (end.empty()) return std::nullopt;
    StateHash hash;
    std::memcpy(&hash, end.data() + mark.size(), sizeof hash);
    return hash;
}

std::optional<Index> read_checked_index(const std::string& path, bool are_rows_wanted) {
    const std::vector<std::byte> bytes = bytes_of_index(path);
    if (bytes.empty()) return std::nullopt;
    const std::size_t hashed = bytes.size() - sizeof(StateHash);
    const StateHash wanted = hash_of(std::span(bytes).first(hashed));
    if (std::memcmp(&wanted, bytes.data() + hashed, sizeof wanted) != 0)
        throw FileError("is damaged: its bytes do not have its checksum");
    Index index = read_index(h5::open_file(path, h5::Access::read).id(), path);
    require_free_files(index.segments.size());
    for (const FileSegment& segment : index.segments) {
        try {
            const std::string part = segment_path(path, segment.name);
            std::error_code error; // a part that may not be seen is an error when it is opened
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
