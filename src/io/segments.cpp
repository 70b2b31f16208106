// SPDX-License-Identifier: BSD-3-Clause
#include "io/segments.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fcntl.h>

#include <fmt/format.h>
#include <xxhash.h>

#include "io/checked_dataset.hpp"
#include "io/crash_guard.hpp"
#include "io/files.hpp"

namespace carrom {

namespace {

constexpr std::string_view mark = "carrom, checked:"; // then 16 bytes of a checksum: the file's end
constexpr std::size_t end_size = mark.size() + 16;
constexpr const char *columns_path = "/carrom/recording/columns",
                     *segments_path = "/carrom/recording/segments";
constexpr std::uint64_t largest_row = std::uint64_t{1} << 48, largest_cell = 64;
constexpr std::size_t n_fixed = 6; ///< numbers of a segment before the places of its columns

StateHash hash_of(std::span<const std::byte> bytes, std::uint64_t seed) {
    const XXH128_hash_t hash = XXH3_128bits_withSeed(bytes.data(), bytes.size(), seed);
    return {hash.low64, hash.high64};
}

void read_all(const Descriptor& file, std::span<std::byte> bytes, std::uint64_t begin) {
    if (file.read(bytes, begin) < bytes.size()) throw FileError("is cut short");
}

/// Calls `act(row, part's first cell, bytes)` for the column's rows [begin, end).
template <class Act>
void for_parts(const Descriptor& file, std::uint64_t place, const Width& width, std::uint64_t begin,
               std::uint64_t end, const Act& act) {
    const std::uint64_t part = std::min(width.cells, cells_per_part);
    const std::uint64_t rows_at_once = cells_per_part / part;
    std::vector<std::byte> buffer(rows_at_once * part * width.bytes_per_cell);
    for (std::uint64_t row = begin; row < end; row += rows_at_once) {
        const std::uint64_t n = width.cells > part ? 1 : std::min(rows_at_once, end - row);
        for (std::uint64_t cell = 0; cell < width.cells; cell += part) {
            const std::uint64_t bytes = std::min(part, width.cells - cell) * width.bytes_per_cell;
            const std::span all = std::span(buffer).first(n * bytes);
            read_all(file, all, place + row * width.bytes_per_row() + cell * width.bytes_per_cell);
            for (std::uint64_t i = 0; i < n; ++i) act(row + i, cell, all.subspan(i * bytes, bytes));
        }
    }
}

std::vector<std::uint64_t> read_table(hid_t file, const char* path, std::size_t& n_rows) {
    const h5::Dataset table = h5::open_checked(file, path, {std::nullopt, std::nullopt});
    const std::vector<hsize_t> sizes = h5::dimensions_of(table.id());
    std::vector<std::uint64_t> numbers(sizes[0] * sizes[1]);
    n_rows = sizes[0];
    if (!numbers.empty())
        h5::checked(
            H5Dread(table.id(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
            path);
    return numbers;
}

/// The file's bytes, if they end as those of an index do.
std::vector<std::byte> bytes_of_index(const std::string& path) {
    const Descriptor file(path, O_RDONLY);
    std::array<std::byte, mark.size()> end;
    const std::uint64_t size = file.size();
    if (size < end_size) return {};
    read_all(file, end, size - end_size);
    if (std::memcmp(end.data(), mark.data(), mark.size()) != 0) return {};
    std::vector<std::byte> bytes(size);
    read_all(file, bytes, 0);
    return bytes;
}

} // namespace

/// A part's seed is its place. Sums of hashes have no order, so parts may come in any.
StateHash hash_of_part(std::size_t column, std::uint64_t row, std::uint64_t begin,
                       std::span<const std::byte> bytes) {
    return hash_of(bytes, ((row * 64 + column) << 20) + begin / cells_per_part);
}

StateHash hash_of_rows(const Descriptor& file, const Segment& segment,
                       const std::vector<Width>& widths, std::uint64_t begin, std::uint64_t end) {
    StateHash sum;
    for (std::size_t k = 0; k < widths.size(); ++k)
        for_parts(file, segment.places[k], widths[k], begin, end,
                  [&](std::uint64_t row, std::uint64_t cell, std::span<const std::byte> bytes) {
                      sum += hash_of_part(k, row, cell, bytes);
                  });
    return sum;
}

/// Of all bytes that are no column's, and of their places.
StateHash hash_of_structure(const Descriptor& file, const Segment& segment,
                            const std::vector<Width>& widths) {
    const std::uint64_t size = file.size();
    std::vector<std::pair<std::uint64_t, std::uint64_t>> parts; // first byte, end
    for (const Width& width : widths)
        if (segment.room > size / width.bytes_per_row() || segment.rows > segment.room)
            throw FileError("is cut short");
    for (std::size_t k = 0; k < widths.size(); ++k)
        parts.emplace_back(segment.places[k],
                           segment.places[k] + segment.room * widths[k].bytes_per_row());
    std::sort(parts.begin(), parts.end());
    parts.emplace_back(size, size);
    StateHash sum;
    std::uint64_t begin = 0;
    for (const auto& [first, end] : parts) {
        constexpr std::uint64_t largest = 1 << 20; // a segment has some KiB of structure
        if (first < begin || first - begin > largest) throw FileError("has another structure");
        std::vector<std::byte> bytes(first - begin);
        read_all(file, bytes, begin);
        sum += hash_of(bytes, begin);
        begin = std::max(first, end);
    }
    return sum;
}

/// Throws unless the structure and the rows [begin, rows) are whole; `begin` rows before are left
/// out of the sum that is known.
void check_segment(const std::string& folder, const Segment& segment,
                   const std::vector<Width>& widths, bool are_rows_wanted) {
    try {
        const Descriptor file((std::filesystem::path(folder) / segment.name).string(),
                              O_RDONLY | O_NOFOLLOW);
        if (hash_of_structure(file, segment, widths) != segment.structure)
            throw FileError("its structure is damaged");
        if (are_rows_wanted &&
            hash_of_rows(file, segment, widths, 0, segment.rows) != segment.numbers)
            throw FileError("its numbers are damaged");
    } catch (const FileError& error) {
        throw FileError(fmt::format("its part {}: {}", segment.name, error.what()));
    }
}

std::string segment_name(const std::string& path, std::size_t number) {
    return fmt::format("{}/{:04}.h5", std::filesystem::path(path).stem().string(), number);
}

Index read_index(hid_t file, const std::string& path) {
    Index index;
    std::size_t n_columns = 0, n_segments = 0;
    const std::vector<std::uint64_t> columns = read_table(file, columns_path, n_columns),
                                     numbers = read_table(file, segments_path, n_segments);
    if (n_columns == 0 || columns.size() != 2 * n_columns ||
        numbers.size() != n_segments * (n_fixed + n_columns))
        throw FileError("its list of segments has another shape");
    for (std::size_t k = 0; k < n_columns; ++k)
        index.widths.push_back({columns[2 * k], columns[2 * k + 1]});
    for (const Width& width : index.widths)
        if (width.cells == 0 || width.cells > largest_row || width.bytes_per_cell == 0 ||
            width.bytes_per_cell > largest_cell)
            throw FileError("its columns are of another kind than this program writes");
    for (std::size_t k = 0; k < n_segments; ++k) {
        const auto row = std::span(numbers).subspan(k * (n_fixed + n_columns), n_fixed + n_columns);
        index.segments.push_back({segment_name(path, k + 1),
                                  row[0],
                                  row[1],
                                  {row[2], row[3]},
                                  {row[4], row[5]},
                                  {row.begin() + n_fixed, row.end()}});
    }
    return index;
}

void write_index(hid_t file, const Index& index) {
    std::vector<std::uint64_t> widths, segments;
    for (const Width& width : index.widths)
        widths.insert(widths.end(), {width.cells, width.bytes_per_cell});
    for (const Segment& segment : index.segments) {
        segments.insert(segments.end(),
                        {segment.rows, segment.room, segment.numbers.low, segment.numbers.high,
                         segment.structure.low, segment.structure.high});
        segments.insert(segments.end(), segment.places.begin(), segment.places.end());
    }
    static_cast<void>(h5::create_group(file, "/carrom/recording"));
    const hsize_t n_columns = index.widths.size(), n_segments = index.segments.size();
    h5::write_whole(file, columns_path, std::array<hsize_t, 2>{n_columns, 2}, H5T_STD_U64LE,
                    widths.data());
    h5::write_whole(file, segments_path, std::array<hsize_t, 2>{n_segments, n_fixed + n_columns},
                    H5T_STD_U64LE, segments.data());
}

/// Appends the mark and a checksum of all bytes.
void seal_index(const std::string& path) {
    const Descriptor file(path, O_RDWR);
    const std::uint64_t size = file.size();
    std::vector<std::byte> bytes(size + end_size);
    read_all(file, std::span(bytes).first(size), 0);
    std::memcpy(bytes.data() + size, mark.data(), mark.size());
    const StateHash hash = hash_of(std::span(bytes).first(size + mark.size()), 0);
    std::memcpy(bytes.data() + size + mark.size(), &hash, sizeof hash);
    file.write(std::span(bytes).subspan(size), size);
    file.sync();
}

bool joins_segments(const std::string& path) { return !bytes_of_index(path).empty(); }

void check_segments(const std::string& path, bool are_all) {
    const std::vector<std::byte> bytes = bytes_of_index(path);
    if (bytes.empty()) throw FileError("does not end as a recording of this program does");
    const std::size_t hashed = bytes.size() - sizeof(StateHash);
    const StateHash wanted = hash_of(std::span(bytes).first(hashed), 0);
    if (std::memcmp(&wanted, bytes.data() + hashed, sizeof wanted) != 0)
        throw FileError("is damaged: its bytes do not have its checksum");
    const CrashGuard guard(path);
    const h5::File file = h5::open_file(path, h5::Access::read);
    const Index index = read_index(file.id(), path);
    for (const Segment& segment : index.segments)
        check_segment(folder_of(path), segment, index.widths, are_all);
}

} // namespace carrom
