// SPDX-License-Identifier: BSD-3-Clause
#include "scene/disc_reader.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "scene/disc_columns.hpp"
#include "scene/limits.hpp"
#include "scene/number.hpp"

namespace carrom {

namespace {

/// The columns of a line, for messages.
std::string columns_text(const std::vector<DiscColumn>& columns) {
    std::string text = "id x y vx vy";
    for (const DiscColumn column : columns) text += std::string(" ") + name_of(column);
    return text;
}

} // namespace

DiscReader::DiscReader(std::istream& stream, const SceneParameters& scene)
    : scene_(scene), species_(scene.effects.species, scene.radius),
      place_(scene.discs_file.empty() && scene.discs_from.empty() ? scene.name : discs_path(scene)),
      lines_(stream, scene.discs_file.empty() ? scene.lines_before_discs : 0) {}

bool DiscReader::read(std::vector<InputDisc>& chunk, std::size_t limit) {
    chunk.clear();
    std::string_view line;
    while (chunk.size() < limit && n_problems_ < most_wrong_lines && lines_.next(line)) {
        if (lines_.is_cut()) {
            refuse(fmt::format("a line of more than {} characters", LineReader::longest_line));
            continue;
        }
        if (lines_.line_number() == 1 && line.starts_with(byte_order_mark))
            line.remove_prefix(byte_order_mark.size());
        InputDisc disc;
        if (!trimmed(line).empty() && parse(line, disc)) chunk.push_back(disc);
    }
    return !chunk.empty();
}

std::vector<Problem> DiscReader::problems() const {
    std::vector<Problem> all = problems_;
    if (n_problems_ > problems_.size())
        all.push_back(
            {place_, 0,
             fmt::format("and {} more lines with problems{}", n_problems_ - problems_.size(),
                         n_problems_ < most_wrong_lines ? "" : "; it was not read beyond them")});
    if (lines_.is_endless())
        all.push_back(
            {place_, lines_.line_number(), "this line does not end: it was not read beyond"});
    if (lines_.has_failed())
        all.push_back({place_, lines_.line_number(), "cannot be read beyond this line"});
    if (n_seen_ < scene_.n_discs) all.push_back({place_, 0, missing_ids()});
    return all;
}

/// Whether the line is a disc. If not, notes its errors as one problem.
bool DiscReader::parse(std::string_view line, InputDisc& disc) {
    const std::vector<DiscColumn>& columns = scene_.disc_columns;
    const std::size_t n_words = 5 + columns.size();
    split_words(line, n_words, words_);
    const bool has_id = note_id(words_[0], disc.id);
    if (!has_id) return false;
    if (words_.size() < n_words) {
        refuse(fmt::format("expected '{}', found only {} of the {} numbers", columns_text(columns),
                           words_.size(), n_words));
        return false;
    }
    std::string text;
    const auto add = [&text](const std::string& fault) {
        text += (text.empty() ? "" : "; ") + fault;
    };
    SizeAndMass body = species_.of(disc.id);
    BySideColumn<double> beside;
    std::array<double*, 6 + n_side_columns> numbers = {&disc.x, &disc.y, &disc.vx, &disc.vy};
    for (std::size_t k = 0; k < columns.size(); ++k)
        numbers[4 + k] = &number_of(columns[k], body, beside);
    for (std::size_t i = 0; i + 1 < n_words; ++i) {
        const auto number = parse_double(words_[i + 1]);
        if (number)
            *numbers[i] = *number;
        else
            add(fmt::format("{} is not a number", in_quotes(words_[i + 1])));
    }
    const bool are_numbers = text.empty();
    for (std::size_t k = 0; k < columns.size() && are_numbers; ++k)
        if (const std::string fault = column_problem(columns[k], *numbers[4 + k]); !fault.empty())
            add(fault);
    if (text.empty()) text = disc_problem(disc, scene_, body.radius);
    if (words_.size() > n_words)
        add(fmt::format("{} after the {} numbers '{}'", in_quotes(words_[n_words]), n_words,
                        columns_text(columns)));
    if (text.empty()) return true;
    refuse(std::move(text));
    return false;
}

bool DiscReader::note_id(std::string_view word, DiscId& id) {
    const auto number = parse_id(word);
    const auto integer = parse_integer(word);
    if (!number && !integer) {
        refuse(fmt::format("{} is not the id of a disc", in_quotes(word)));
    } else if (!number || *number >= most_discs()) {
        refuse(fmt::format("disc {} is out of range: ids are 0 to {}", word, most_discs() - 1));
    } else if (has_seen(*number)) {
        refuse(fmt::format("disc {} is listed twice", *number));
    } else {
        constexpr std::uint64_t most_without_n = std::uint64_t{1} << 27;
        const std::uint64_t most_seen = scene_.n_discs > 0 ? scene_.n_discs : most_without_n;
        if (*number >= seen_.size())
            seen_.resize(std::min(most_seen, 2 * *number + 64)); // N may be a mistake
        if (*number < seen_.size()) seen_[*number] = true;
        n_seen_ += 1;
        id = *number;
        return true;
    }
    return false;
}

void DiscReader::refuse(std::string text) {
    n_problems_ += 1;
    if (problems_.size() < most_problems)
        problems_.push_back({place_, lines_.line_number(), std::move(text)});
}

std::uint64_t DiscReader::most_discs() const {
    return scene_.n_discs > 0 ? scene_.n_discs : largest_count;
}

std::string DiscReader::missing_ids() const {
    constexpr std::size_t most_ranges = 10;
    std::string list;
    std::size_t n_ranges = 0;
    for (DiscId id = 0; id < scene_.n_discs && n_ranges <= most_ranges; ++id) {
        if (has_seen(id)) continue;
        const DiscId first = id;
        while (id + 1 < seen_.size() && !seen_[id + 1]) ++id;
        if (id + 1 >= seen_.size()) id = scene_.n_discs - 1; // no larger ids were seen
        if (++n_ranges > most_ranges)
            list += ", ...";
        else
            list += fmt::format("{}{}", list.empty() ? "" : ", ",
                                first == id ? fmt::format("{}", id)
                                            : fmt::format("{}-{}", first, id));
    }
    return fmt::format("{} of {} discs are missing: {}", scene_.n_discs - n_seen_, scene_.n_discs,
                       list);
}

std::vector<Problem> disc_line_problems(std::istream& stream, const SceneParameters& scene) {
    constexpr std::size_t chunk_size = 4096;
    DiscReader reader(stream, scene);
    std::vector<InputDisc> chunk;
    while (reader.read(chunk, chunk_size)) {
    }
    return reader.problems();
}

} // namespace carrom
