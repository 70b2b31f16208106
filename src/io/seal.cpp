// SPDX-License-Identifier: BSD-3-Clause
#include "seal.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <vector>

#include <fcntl.h>

#include <fmt/format.h>
#include <xxhash.h>

#include "carrom/core/state_hash.hpp"
#include "carrom/parallel/slabs.hpp"
#include "files.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t chunk_size = 1 << 20;
constexpr std::string_view title = "carrom checkpoint, format 1\n";
constexpr std::string_view family = "carrom checkpoint, format ";

using Block = std::array<char, seal_size>;

/// This rank's part of the sum over the bytes behind the seal.
StateHash share_of_checksum(const Descriptor& file, std::uint64_t size, const Communicator& communicator) {
    const std::uint64_t n_chunks = (size - seal_size + chunk_size - 1) / chunk_size;
    const std::uint64_t first = slab_begin(communicator.rank(), n_chunks, communicator.size());
    const std::uint64_t last = slab_begin(communicator.rank() + 1, n_chunks, communicator.size());
    std::vector<std::byte> bytes(chunk_size);
    StateHash sum;
    for (std::uint64_t chunk = first; chunk < last; ++chunk) {
        const std::uint64_t begin = seal_size + chunk * chunk_size;
        const auto wanted = std::span(bytes).first(std::min(chunk_size, size - begin));
        if (file.read(wanted, begin) < wanted.size()) throw FileError("ends while it is being read");
        const XXH128_hash_t hash = XXH3_128bits_withSeed(wanted.data(), wanted.size(), chunk);
        sum += {hash.low64, hash.high64};
    }
    return sum;
}

StateHash total(StateHash share, const Communicator& communicator) {
    std::array<std::uint64_t, 2> words = {share.low, share.high}; // summed word by word, like the shares
    communicator.sum(words);
    return {words[0], words[1]};
}

Block seal_text(std::uint64_t size, const StateHash& checksum) {
    const std::string text = fmt::format("{}bytes {}\nchecksum {}\n", title, size, to_string(checksum));
    Block block{};
    std::copy(text.begin(), text.end(), block.begin());
    return block;
}

/// The size that the seal speaks of; throws where there is no seal.
std::uint64_t sealed_size(const Block& block) {
    const std::string_view text(block.data(), block.size());
    if (!text.starts_with(family)) throw FileError("is no checkpoint of carrom, or was never finished");
    if (!text.starts_with(title)) throw FileError("is a checkpoint of another format than this version reads");
    const std::string_view word = "bytes ";
    std::uint64_t size = 0;
    const char* const begin = text.data() + title.size() + word.size();
    if (!text.substr(title.size()).starts_with(word) || std::from_chars(begin, text.data() + text.size(), size).ec != std::errc{})
        throw FileError("is damaged in its first lines");
    return size;
}

} // namespace

void seal(const std::string& path, const Communicator& communicator) {
    StateHash share;
    std::uint64_t size = 0;
    on_all(communicator, path, ExitCode::output_failure, [&] {
        const Descriptor file(path, O_RDONLY);
        size = file.size();
        share = share_of_checksum(file, size, communicator);
    });
    const StateHash checksum = total(share, communicator);
    on_root(communicator, path, ExitCode::output_failure, [&] {
        const Descriptor file(path, O_WRONLY);
        const Block block = seal_text(size, checksum);
        file.write(std::as_bytes(std::span(block)), 0);
        file.sync();
    });
}

bool is_sealed(const std::string& path) {
    constexpr std::string_view signature = "\x89HDF\r\n\x1a\n"; // where HDF5 begins
    std::array<char, seal_size + signature.size()> bytes{};
    Descriptor(path, O_RDONLY).read(std::as_writable_bytes(std::span(bytes)), 0);
    const std::string_view text(bytes.data(), bytes.size());
    return text.starts_with(family) || text.substr(seal_size) == signature;
}

void check_seal(const std::string& path, const Communicator& communicator) {
    Block block{};
    std::uint64_t size = 0;
    on_root(communicator, path, ExitCode::bad_input, [&] {
        const Descriptor file(path, O_RDONLY);
        file.read(std::as_writable_bytes(std::span(block)), 0);
        size = file.size();
        const std::uint64_t wanted = sealed_size(block);
        if (size != wanted) throw FileError(fmt::format("has {} bytes instead of {}", size, wanted));
        if (size < seal_size) throw FileError("is cut short");
    });
    communicator.broadcast(size);
    StateHash share;
    on_all(communicator, path, ExitCode::bad_input,
           [&] { share = share_of_checksum(Descriptor(path, O_RDONLY), size, communicator); });
    const StateHash checksum = total(share, communicator);
    on_root(communicator, path, ExitCode::bad_input, [&] {
        if (block != seal_text(size, checksum)) throw FileError("is damaged: its bytes do not have the checksum they had when it was written");
    });
}

} // namespace carrom
