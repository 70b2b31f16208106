// SPDX-License-Identifier: BSD-3-Clause
#include "io/seal.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include <fcntl.h>

#include <fmt/format.h>
#include <xxhash.h>

#include "io/files.hpp"
#include "io/seal_text.hpp"
#include "parallel/slabs.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t bytes_at_a_time = 1 << 20;

StateHash as_state_hash(const XXH128_hash_t& hash) { return {hash.low64, hash.high64}; }

void read_all(const Descriptor& file, std::span<std::byte> bytes, std::uint64_t begin) {
    if (file.read(bytes, begin) < bytes.size()) throw FileError("ends while it is being read");
}

/// This rank's share of the sum over the bytes behind a seal of format 1.
StateHash share_of_whole(const Descriptor& file, std::uint64_t size,
                         const Communicator& communicator) {
    const std::uint64_t n_chunks = (size - seal_size + bytes_at_a_time - 1) / bytes_at_a_time;
    const std::uint64_t first = slab_begin(communicator.rank(), n_chunks, communicator.size());
    const std::uint64_t last = slab_begin(communicator.rank() + 1, n_chunks, communicator.size());
    std::vector<std::byte> bytes(bytes_at_a_time);
    StateHash sum;
    for (std::uint64_t chunk = first; chunk < last; ++chunk) {
        const std::uint64_t begin = seal_size + chunk * bytes_at_a_time;
        const auto wanted = std::span(bytes).first(std::min(bytes_at_a_time, size - begin));
        read_all(file, wanted, begin);
        sum += as_state_hash(XXH3_128bits_withSeed(wanted.data(), wanted.size(), chunk));
    }
    return sum;
}

/// This rank's share of the sum over a data set.
StateHash share_of_part(const Descriptor& file, const SealedPart& part,
                        const Communicator& communicator) {
    const std::uint64_t n_blocks = (part.rows + rows_per_block - 1) / rows_per_block;
    const std::uint64_t last = slab_begin(communicator.rank() + 1, n_blocks, communicator.size());
    const std::uint64_t block_size = rows_per_block * part.bytes_per_row;
    const std::uint64_t blocks_at_a_time = std::max<std::uint64_t>(1, bytes_at_a_time / block_size);
    std::vector<std::byte> bytes(blocks_at_a_time * block_size);
    StateHash sum;
    for (std::uint64_t block = slab_begin(communicator.rank(), n_blocks, communicator.size());
         block < last;) {
        const std::uint64_t begin = part.begin + block * block_size;
        const std::uint64_t end = std::min(
            part.begin + std::min(last, block + blocks_at_a_time) * block_size, part.end());
        read_all(file, std::span(bytes).first(end - begin), begin);
        for (std::uint64_t place = begin; place < end; place += block_size, ++block)
            sum += checksum_of_block(
                std::span(bytes).subspan(place - begin, std::min(block_size, end - place)), block);
    }
    return sum;
}

/// Of all bytes behind the seal that are in no part, as if they stood side by side.
StateHash checksum_of_rest(const Descriptor& file, std::uint64_t size,
                           const std::vector<SealedPart>& parts) {
    const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                                XXH3_freeState);
    ensure(state != nullptr && XXH3_128bits_reset(state.get()) == XXH_OK,
           "no memory for a checksum");
    std::vector<std::byte> bytes(bytes_at_a_time);
    std::uint64_t place = seal_size;
    const auto hash_up_to = [&](std::uint64_t end) {
        for (; place < end; place += std::min(bytes_at_a_time, end - place)) {
            const auto wanted = std::span(bytes).first(std::min(bytes_at_a_time, end - place));
            read_all(file, wanted, place);
            XXH3_128bits_update(state.get(), wanted.data(), wanted.size());
        }
    };
    for (const SealedPart& part : parts) {
        hash_up_to(part.begin);
        place = part.end();
    }
    hash_up_to(size);
    return as_state_hash(XXH3_128bits_digest(state.get()));
}

SealBlock read_block(const Descriptor& file) {
    SealBlock block{};
    file.read(std::as_writable_bytes(std::span(block)), 0);
    return block;
}

/// The seal of a file on every rank, once its size is right. **Collective.**
Seal shared_seal(const std::string& path, const Communicator& communicator) {
    std::string text;
    on_root(communicator, path, ExitCode::bad_input, [&] {
        const Descriptor file(path, O_RDONLY);
        const SealBlock block = read_block(file);
        const std::uint64_t wanted = sealed_size(block), size = file.size();
        if (size != wanted)
            throw FileError(fmt::format("has {} bytes instead of {}", size, wanted));
        if (size < seal_size) throw FileError("is cut short");
        static_cast<void>(parsed(block));
        text.assign(block.data(), block.size());
    });
    communicator.broadcast(text);
    SealBlock block{};
    std::copy(text.begin(), text.end(), block.begin());
    return parsed(block);
}

/// What rank 0 finds: the names of the data sets that are not as they were, and whether anything
/// else is not.
std::string damage(const Descriptor& file, const Seal& seal, std::span<const std::uint64_t> sums) {
    if (seal.format == 1)
        return StateHash{sums[0], sums[1]} == seal.rest
                   ? ""
                   : "its bytes do not have the checksum they had when it was written";
    std::string names;
    for (std::size_t k = 0; k < seal.parts.size(); ++k)
        if (StateHash{sums[2 * k], sums[2 * k + 1]} != seal.parts[k].checksum)
            names += (names.empty() ? "" : ", ") + seal.parts[k].name;
    if (checksum_of_rest(file, seal.size, seal.parts) != seal.rest)
        names += (names.empty() ? "" : ", ") + std::string("what stands between the data sets");
    return names.empty()
               ? ""
               : "these bytes do not have the checksum they had when it was written: " + names;
}

} // namespace

StateHash checksum_of_block(std::span<const std::byte> bytes, std::uint64_t block) {
    return as_state_hash(XXH3_128bits_withSeed(bytes.data(), bytes.size(), block));
}

void seal(const std::string& path, const std::vector<SealedPart>& parts) {
    const Descriptor file(path, O_RDWR);
    const std::uint64_t size = file.size();
    const SealBlock block = block_of({2, size, checksum_of_rest(file, size, parts), parts});
    file.write(std::as_bytes(std::span(block)), 0);
    file.sync();
}

bool is_sealed(const std::string& path) {
    constexpr std::string_view signature = "\x89HDF\r\n\x1a\n"; // where HDF5 begins
    std::array<char, seal_size + signature.size()> bytes{};
    Descriptor(path, O_RDONLY).read(std::as_writable_bytes(std::span(bytes)), 0);
    const std::string_view text(bytes.data(), bytes.size());
    return text.starts_with(seal_family) || text.substr(seal_size) == signature;
}

std::vector<SealedPart> sealed_parts(const std::string& path) {
    return parsed(read_block(Descriptor(path, O_RDONLY))).parts;
}

void check_seal(const std::string& path, const Communicator& communicator) {
    const Seal seal = shared_seal(path, communicator);
    std::vector<std::uint64_t> sums; // summed word by word, like the shares
    on_all(communicator, path, ExitCode::bad_input, [&] {
        const Descriptor file(path, O_RDONLY);
        const auto add = [&sums](const StateHash& share) {
            sums.insert(sums.end(), {share.low, share.high});
        };
        if (seal.format == 1) add(share_of_whole(file, seal.size, communicator));
        for (const SealedPart& part : seal.parts) add(share_of_part(file, part, communicator));
    });
    communicator.sum(sums);
    on_root(communicator, path, ExitCode::bad_input, [&] {
        const std::string found = damage(Descriptor(path, O_RDONLY), seal, sums);
        if (!found.empty()) throw FileError("is damaged: " + found);
    });
}

} // namespace carrom
