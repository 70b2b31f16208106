// SPDX-License-Identifier: BSD-3-Clause
#include "io/seal.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include <fcntl.h>

#include "io/checksums.hpp"
#include "io/files.hpp"

namespace carrom {

namespace {

// The beginning of a seal; 16 bytes of checksum follow and end the file
constexpr std::string_view mark = "carrom, checked:";
constexpr std::size_t end_size = mark.size() + sizeof(StateHash);

constexpr std::string_view heap_signature = "GCOL";
constexpr std::uint64_t largest_searched = 16 << 20;
constexpr std::size_t heap_header = 16, object_header = 16, place_of_size = 8, alignment = 8;

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

/// The mark and the checksum; nothing if the file does not end with a seal.
std::vector<std::byte> end_of_index(const Descriptor& file) {
    if (file.size() < end_size) return {};
    std::vector<std::byte> end = read_end(file, file.size() - end_size);
    if (std::memcmp(end.data(), mark.data(), mark.size()) != 0) return {};
    return end;
}

/// HDF5 stores lengths in 8 bytes, the lowest one first.
std::uint64_t length_at(std::string_view bytes) {
    std::uint64_t length = 0;
    for (std::size_t k = 8; k-- > 0;) length = length << 8 | static_cast<unsigned char>(bytes[k]);
    return length;
}

/// Whether HDF5 reaches the end of a heap's list of objects. Free space is an object with number 0.
bool has_end(std::string_view heap) {
    if (heap.size() < heap_header) return true;
    const std::uint64_t size = length_at(heap.substr(place_of_size));
    heap = heap.substr(0, std::min<std::uint64_t>(size, heap.size()));
    std::size_t place = heap_header;
    while (place + object_header <= heap.size()) {
        const std::string_view object = heap.substr(place);
        const std::uint64_t length = length_at(object.substr(place_of_size));
        const bool is_free_room = object[0] == 0 && object[1] == 0;
        if (is_free_room && length == 0) return false;
        if (length > object.size()) return true; // HDF5 itself detects this damage
        place += is_free_room ? length
                              : object_header + (length + alignment - 1) / alignment * alignment;
    }
    return true;
}

} // namespace

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

bool check_seal(const std::string& path) {
    const Descriptor file(path, O_RDONLY);
    if (end_of_index(file).empty()) return false;
    const std::vector<std::byte> bytes = read_end(file, 0);
    const std::size_t hashed = bytes.size() - sizeof(StateHash);
    const StateHash wanted = hash_of(std::span(bytes).first(hashed));
    if (std::memcmp(&wanted, bytes.data() + hashed, sizeof wanted) != 0)
        throw FileError("is damaged: its bytes do not have its checksum");
    return true;
}

void check_heaps(const std::string& path) {
    const Descriptor file(path, O_RDONLY);
    if (file.size() > largest_searched) return;
    const std::vector<std::byte> bytes = read_end(file, 0);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (std::size_t place = text.find(heap_signature); place != std::string_view::npos;
         place = text.find(heap_signature, place + 1))
        if (!has_end(text.substr(place)))
            throw FileError("is damaged: HDF5 would come to no end in one of its heaps");
}

} // namespace carrom
