// SPDX-License-Identifier: BSD-3-Clause
#include "io/checksums.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <string_view>

#include <fcntl.h>

#include <fmt/format.h>
#include <xxhash.h>

#include "core/errors.hpp"
#include "io/checked_dataset.hpp"
#include "io/files.hpp"
#include "parallel/slabs.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t bytes_at_a_time = 1 << 20;
constexpr std::size_t n_digits = 32;
constexpr std::string_view blanks = "  ", others_name = "all other bytes",
                           lines_name = "the lines above";

StateHash as_state_hash(const XXH128_hash_t& hash) { return {hash.low64, hash.high64}; }

std::uint64_t number_of(std::string_view digits) {
    std::uint64_t number = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
    return number;
}

std::string line(const StateHash& hash, std::string_view name) {
    return fmt::format("{}{}{}\n", to_string(hash), blanks, name);
}

/// Accepts only texts that this program writes, so that each set of sums has exactly one text.
Checksums parsed(const std::string& text) {
    Checksums sums;
    std::istringstream lines(text);
    for (std::string one; std::getline(lines, one);) {
        one.resize(std::max(one.size(), n_digits + blanks.size()));
        const std::string_view digits = std::string_view(one).substr(0, n_digits);
        const StateHash hash = {number_of(digits.substr(n_digits / 2)),
                                number_of(digits.substr(0, n_digits / 2))};
        const std::string name = one.substr(n_digits + blanks.size());
        if (name == others_name)
            sums.others = hash;
        else if (name != lines_name)
            sums.data.push_back({name, 0, 0, {}, hash});
    }
    if (sums.text() != text) throw FileError("is damaged in its checksums");
    return sums;
}

ByteRange place_of(hid_t dataset, const std::string& path) {
    const haddr_t begin = H5Dget_offset(dataset);
    if (begin == HADDR_UNDEF) throw FileError(path + " has no place in the file");
    return {begin, begin + H5Dget_storage_size(dataset)};
}

} // namespace

Hasher::Hasher() : state_(XXH3_createState()) {
    ensure(state_ != nullptr && XXH3_128bits_reset(state_.get()) == XXH_OK,
           "no memory for a checksum");
}

void Hasher::Delete::operator()(XXH3_state_s* state) const { XXH3_freeState(state); }

void Hasher::add(std::span<const std::byte> bytes) {
    XXH3_128bits_update(state_.get(), bytes.data(), bytes.size());
}

void Hasher::add_bytes_of(const std::string& path, const ByteRange& range) {
    const Descriptor file(path, O_RDONLY);
    std::vector<std::byte> bytes(std::min(bytes_at_a_time, range.end - range.begin));
    for (std::uint64_t place = range.begin; place < range.end; place += bytes.size()) {
        const auto wanted = std::span(bytes).first(
            std::min<std::uint64_t>(bytes.size(), range.end - place));
        if (file.read(wanted, place) < wanted.size()) throw FileError("is cut short");
        add(wanted);
    }
}

StateHash Hasher::digest() const { return as_state_hash(XXH3_128bits_digest(state_.get())); }

StateHash checksum_of_block(std::span<const std::byte> bytes, std::uint64_t block) {
    return as_state_hash(XXH3_128bits_withSeed(bytes.data(), bytes.size(), block));
}

void sum_over(const Communicator& communicator, std::span<StateHash> sums) {
    std::vector<std::uint64_t> words;
    for (const StateHash& sum : sums) words.insert(words.end(), {sum.low, sum.high});
    communicator.sum(words);
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] = {words[2 * k], words[2 * k + 1]};
}

std::string Checksums::text() const {
    std::string text;
    for (const DiscData& one : data) text += line(one.checksum, one.path);
    text += line(others, others_name);
    return text + line(as_state_hash(XXH3_128bits(text.data(), text.size())), lines_name);
}

std::vector<ByteRange> Checksums::left_out() const {
    std::vector<ByteRange> extents = {place};
    for (const DiscData& one : data) extents.push_back(one.place);
    return extents;
}

Checksums read_checksums(hid_t file) {
    std::string text;
    h5::read_scalar(file, checksums_path, text);
    Checksums sums = parsed(text);
    sums.place = place_of(h5::open_checked(file, checksums_path).id(), checksums_path);
    for (DiscData& one : sums.data) {
        if (!h5::has(file, one.path)) throw FileError("has no " + one.path);
        const h5::Dataset dataset = h5::open_checked(file, one.path);
        one.place = place_of(dataset.id(), one.path);
        one.rows = h5::n_rows_of(dataset.id());
        const std::uint64_t size = one.place.end - one.place.begin;
        one.bytes_per_row = size / std::max<std::uint64_t>(1, one.rows);
        if (size == 0 || one.rows * one.bytes_per_row != size)
            throw FileError(one.path + " has another size than its rows");
    }
    return sums;
}

bool has_traces_of_checkpoint(const std::string& path) {
    const std::array traces = {fmt::format("{}{}\n", blanks, others_name),
                               std::string("micro_steps_done")}; // a name in /carrom/run
    const std::size_t longest = std::max(traces[0].size(), traces[1].size());
    const Descriptor file(path, O_RDONLY);
    std::string text(bytes_at_a_time, '\0');
    std::uint64_t place = 0;
    for (;;) {
        const std::size_t n = file.read(std::as_writable_bytes(std::span(text)), place);
        const std::string_view found = std::string_view(text).substr(0, n);
        for (const std::string& trace : traces)
            if (found.find(trace) != std::string_view::npos) return true;
        if (n < text.size()) return false;
        place += n - longest; // reads the last bytes again: a trace may begin there
    }
}

StateHash checksum_of_others(const std::string& path, std::vector<ByteRange> left_out) {
    std::sort(left_out.begin(), left_out.end(),
              [](const ByteRange& a, const ByteRange& b) { return a.begin < b.begin; });
    const std::uint64_t size = Descriptor(path, O_RDONLY).size();
    left_out.push_back({size, size});
    Hasher hasher;
    std::uint64_t place = 0;
    for (const ByteRange& hole : left_out) {
        if (hole.begin < place || hole.end < hole.begin || hole.end > size)
            throw FileError("is damaged: its data sets lie over each other, or it is cut short");
        hasher.add_bytes_of(path, {place, hole.begin});
        place = hole.end;
    }
    return hasher.digest();
}

StateHash share_of_checksum(hid_t dataset, const DiscData& data, const Communicator& communicator) {
    const std::uint64_t n_blocks = (data.rows + rows_per_block - 1) / rows_per_block;
    auto [block, last] = slab_of_rank(communicator.rank(), n_blocks, communicator.size());
    const std::uint64_t block_size = rows_per_block * data.bytes_per_row;
    const std::uint64_t at_a_time = std::max<std::uint64_t>(1, bytes_at_a_time / block_size);
    const h5::Type stored = h5::stored_type(dataset);
    std::vector<std::byte> bytes(at_a_time * block_size);
    StateHash sum;
    while (block < last) {
        const std::uint64_t begin = block * rows_per_block;
        const std::uint64_t end = std::min(std::min(last, block + at_a_time) * rows_per_block,
                                           data.rows);
        h5::read_rows(dataset, {begin, end}, stored.id(), bytes.data());
        auto rest = std::span(bytes).first((end - begin) * data.bytes_per_row);
        for (; !rest.empty(); rest = rest.subspan(std::min(block_size, rest.size())))
            sum += checksum_of_block(rest.first(std::min(block_size, rest.size())), block++);
    }
    return sum;
}

} // namespace carrom
