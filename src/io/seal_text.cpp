// SPDX-License-Identifier: BSD-3-Clause
#include "io/seal_text.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <xxhash.h>

#include "core/errors.hpp"
#include "io/files.hpp"

namespace carrom {

namespace {

constexpr std::string_view formats[] = {"carrom checkpoint, format 1\n",
                                        "carrom checkpoint, format 2\n"};

[[noreturn]] void refuse() { throw FileError("is damaged in its first lines"); }

template <class Number> Number number_of(std::string_view text, int base = 10) {
    Number number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
    if (error != std::errc{} || end != text.data() + text.size()) refuse();
    return number;
}

StateHash hash_of_digits(std::string_view text) {
    if (text.size() != 32) refuse();
    return {number_of<std::uint64_t>(text.substr(16), 16),
            number_of<std::uint64_t>(text.substr(0, 16), 16)};
}

/// The words of the next line behind its first one, which must be `title`.
std::vector<std::string> next_line(std::istringstream& lines, std::string_view title,
                                   std::size_t n_words) {
    std::string line, word;
    if (!std::getline(lines, line)) refuse();
    std::istringstream stream(line);
    std::vector<std::string> words;
    while (stream >> word) words.push_back(word);
    if (words.size() != n_words + 1 || words.front() != title) refuse();
    words.erase(words.begin());
    return words;
}

std::string text_of(const Seal& seal) {
    if (seal.format == 1)
        return fmt::format("{}bytes {}\nchecksum {}\n", formats[0], seal.size,
                           to_string(seal.rest));
    std::string text = fmt::format("{}bytes {}\nparts {}\n", formats[1], seal.size,
                                   seal.parts.size());
    for (const SealedPart& part : seal.parts)
        text += fmt::format("part {} at {} rows {} of {} checksum {}\n", part.name, part.begin,
                            part.rows, part.bytes_per_row, to_string(part.checksum));
    text += fmt::format("rest {}\n", to_string(seal.rest));
    const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
    return text + fmt::format("seal {}\n", to_string(StateHash{hash.low64, hash.high64}));
}

Seal parsed_as_it_stands(const SealBlock& block) {
    Seal seal;
    seal.size = sealed_size(block);
    seal.format = std::string_view(block.data(), block.size()).starts_with(formats[0]) ? 1 : 2;
    std::istringstream lines(std::string(block.data(), block.size()));
    std::string line;
    std::getline(lines, line); // the format
    std::getline(lines, line); // the size
    if (seal.format == 1) {
        seal.rest = hash_of_digits(next_line(lines, "checksum", 1)[0]);
        return seal;
    }
    const auto n_parts = std::min<std::uint64_t>(
        number_of<std::uint64_t>(next_line(lines, "parts", 1)[0]), seal_size);
    for (std::uint64_t k = 0; k < n_parts; ++k) {
        const std::vector<std::string> words = next_line(lines, "part", 9);
        seal.parts.push_back({words[0], number_of<std::uint64_t>(words[2]),
                              number_of<std::uint64_t>(words[4]),
                              number_of<std::uint64_t>(words[6]), hash_of_digits(words[8])});
    }
    seal.rest = hash_of_digits(next_line(lines, "rest", 1)[0]);
    return seal;
}

/// Whether the parts follow each other within the file, with numbers that cannot overflow.
bool has_sound_parts(const Seal& seal) {
    std::uint64_t end = seal_size;
    for (const SealedPart& part : seal.parts) {
        if (part.begin < end || part.begin > seal.size || part.bytes_per_row < 1 ||
            part.bytes_per_row > seal_size)
            return false;
        if (part.rows > (seal.size - part.begin) / part.bytes_per_row) return false;
        end = part.end();
    }
    return true;
}

} // namespace

SealBlock block_of(const Seal& seal) {
    const std::string text = text_of(seal);
    ensure(text.size() <= seal_size, "a seal does not fit");
    SealBlock block{};
    std::copy(text.begin(), text.end(), block.begin());
    return block;
}

std::uint64_t sealed_size(const SealBlock& block) {
    const std::string_view text(block.data(), block.size());
    if (!text.starts_with(seal_family))
        throw FileError("is no checkpoint of carrom, or was never finished");
    const auto title = std::find_if(
        std::begin(formats), std::end(formats),
        [&](std::string_view format) { return text.starts_with(format); });
    if (title == std::end(formats))
        throw FileError("is a checkpoint of another format than this version reads");
    const std::string_view word = "bytes ", rest = text.substr(title->size());
    if (!rest.starts_with(word)) refuse();
    return number_of<std::uint64_t>(
        rest.substr(word.size(), std::min(rest.find('\n'), rest.size()) - word.size()));
}

Seal parsed(const SealBlock& block) {
    Seal seal = parsed_as_it_stands(block);
    if (!has_sound_parts(seal) || block_of(seal) != block) refuse();
    return seal;
}

} // namespace carrom
