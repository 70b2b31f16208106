// SPDX-License-Identifier: BSD-3-Clause
#include "scene/disc_reader.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "scene/disc_columns.hpp"
#include "scene/limits.hpp"
#include "scene/number.hpp"

namespace carrom {

namespace {

std::optional<std::size_t> place_of_id(const std::vector<DiscColumn>& columns) {
    const auto found = std::ranges::find(columns, DiscColumn::id);
    if (found == columns.end()) return std::nullopt;
    return static_cast<std::size_t>(found - columns.begin());
}

/// A pointer to the number that a column gives; null for the column of ids.
double* place_of(DiscColumn column, InputDisc& disc, SizeAndMass& body,
                 BySideColumn<double>& beside) {
    switch (column) {
    case DiscColumn::id: return nullptr;
    case DiscColumn::x: return &disc.x;
    case DiscColumn::y: return &disc.y;
    case DiscColumn::vx: return &disc.vx;
    case DiscColumn::vy: return &disc.vy;
    default: return &number_of(column, body, beside);
    }
}

std::string too_few_text(const std::vector<DiscColumn>& columns, std::size_t n_words) {
    return fmt::format("expected '{}', found only {} of the {} numbers", names_of(columns), n_words,
                       columns.size());
}

} // namespace

DiscReader::DiscReader(std::istream& stream, const SceneParameters& scene)
    : scene_(scene), species_(scene.effects.species, scene.radius),
      place_(scene.discs_file.empty() && scene.discs_from.empty() ? scene.name : discs_path(scene)),
      has_lines_(scene.discs_from.empty()), columns_(columns_of_lines(scene)),
      place_of_id_(place_of_id(columns_)),
      lines_(stream, scene, scene.discs_file.empty() ? scene.lines_before_discs : 0) {}

DiscReader::DiscReader(std::istream& stream, const SceneParameters& scene, const Part& part)
    : scene_(scene), species_(scene.effects.species, scene.radius), place_(discs_path(scene)),
      has_lines_(scene.discs_from.empty()), columns_(columns_of_lines(scene)),
      place_of_id_(place_of_id(columns_)),
      lines_(stream, scene, part.is_first ? 0 : 1, part.n_bytes, part.is_first),
      are_ids_noted_(false) {}

bool DiscReader::read(std::vector<InputDisc>& chunk, std::size_t limit, const InParts& in_parts) {
    chunk.clear();
    while (chunk.empty() && n_problems_ < most_wrong_lines && take_lines(limit)) {
        in_parts(taken_.size(), [this](std::size_t first, std::size_t last) {
            std::vector<std::string_view> words;
            for (std::size_t k = first; k < last; ++k) parse(taken_[k], words);
        });
        for (Line& line : taken_)
            if (n_problems_ < most_wrong_lines) judge(line, chunk);
    }
    return !chunk.empty();
}

/// Copies up to `limit` lines, because `lines_` keeps only the latest one. Returns false if no line
/// is left.
bool DiscReader::take_lines(std::size_t limit) {
    text_.clear();
    taken_.clear();
    std::string_view line;
    while (taken_.size() < limit && lines_.next(line)) {
        Line& taken = taken_.emplace_back();
        taken.is_cut = lines_.reader().is_cut();
        taken.number = lines_.reader().line_number();
        if (!place_of_id_) taken.disc.id = next_id_++;
        taken.begin = text_.size();
        if (!taken.is_cut) text_.insert(text_.end(), line.begin(), line.end());
        taken.end = text_.size();
    }
    return !taken_.empty();
}

/// Adds the line's disc to the chunk, or its errors as one problem.
void DiscReader::judge(Line& line, std::vector<InputDisc>& chunk) {
    if (line.is_cut)
        return refuse(line,
                      fmt::format("a line of more than {} characters", LineReader::longest_line));
    if (std::string fault = record_id(line); !fault.empty()) return refuse(line, std::move(fault));
    if (!line.fault.empty()) return refuse(line, std::move(line.fault));
    chunk.push_back(line.disc);
}

std::vector<Problem> DiscReader::problems() const {
    std::vector<Problem> all = problems_;
    if (n_problems_ > problems_.size())
        all.push_back(
            {place_, 0,
             fmt::format("and {} more {} with problems{}", n_problems_ - problems_.size(),
                         has_lines_ ? "lines" : "discs",
                         n_problems_ < most_wrong_lines ? "" : "; it was not read beyond them")});
    const LineReader& reader = lines_.reader();
    if (reader.is_endless())
        all.push_back(
            {place_, reader.line_number(), "this line does not end: it was not read beyond"});
    if (reader.has_failed())
        all.push_back({place_, reader.line_number(), "cannot be read beyond this line"});
    if (n_seen_ < scene_.n_discs) all.push_back({place_, 0, missing_ids()});
    return all;
}

/// Reads the disc in `line`. Collects errors in `line.fault`; record_id reports a wrong id.
void DiscReader::parse(Line& line, std::vector<std::string_view>& words) const {
    if (line.is_cut) return;
    const std::size_t n_words = columns_.size();
    split_words(text_of(line), n_words, words);
    InputDisc& disc = line.disc;
    if (place_of_id_) {
        const auto id = *place_of_id_ < words.size() ? parse_id(words[*place_of_id_])
                                                     : std::nullopt;
        line.has_number = id && *id < most_discs();
        if (line.has_number) disc.id = *id;
    } else {
        line.has_number = disc.id < most_discs();
    }
    if (!line.has_number) return;
    if (words.size() < n_words) {
        line.fault = too_few_text(columns_, words.size());
        return;
    }
    std::string& text = line.fault;
    const auto add = [&text](const std::string& fault) {
        text += (text.empty() ? "" : "; ") + fault;
    };
    SizeAndMass body = species_.of(disc.id);
    BySideColumn<double> beside;
    for (std::size_t i = 0; i < n_words; ++i) {
        double* const place = place_of(columns_[i], disc, body, beside);
        if (!place) continue;
        if (const auto number = parse_double(words[i]))
            *place = *number;
        else
            add(fmt::format("{} is not a number", in_quotes(words[i])));
    }
    const bool are_numbers = text.empty();
    for (std::size_t i = 0; i < n_words && are_numbers; ++i)
        if (columns_[i] >= DiscColumn::radius)
            if (const std::string fault = column_problem(
                    columns_[i], *place_of(columns_[i], disc, body, beside));
                !fault.empty())
                add(fault);
    if (has_lines_ && scene_.origin.is_on()) disc.x += scene_.origin.x, disc.y += scene_.origin.y;
    if (text.empty()) text = disc_problem(disc, scene_, body.radius);
    if (words.size() > n_words)
        add(fmt::format("{} after the {} numbers '{}'", in_quotes(words[n_words]), n_words,
                        names_of(columns_)));
}

/// Records the disc's id, or returns why it is wrong.
std::string DiscReader::record_id(const Line& line) {
    if (!line.has_number) {
        if (!place_of_id_)
            return fmt::format("one line too many: the scene is of {} discs", most_discs());
        std::vector<std::string_view> words;
        split_words(text_of(line), columns_.size(), words);
        if (*place_of_id_ >= words.size()) return too_few_text(columns_, words.size());
        const std::string_view id = words[*place_of_id_];
        return parse_id(id) || parse_integer(id)
                   ? fmt::format("disc {} is out of range: ids are 0 to {}", id, most_discs() - 1)
                   : fmt::format("{} is not the id of a disc{}", in_quotes(id),
                                 parse_double(id) && !scene_.discs_file.empty()
                                     ? fmt::format("; lines are '{}', and discs.columns or a "
                                                   "header line name others",
                                                   names_of(columns_))
                                     : "");
    }
    if (!are_ids_noted_) return "";
    const DiscId id = line.disc.id;
    if (has_seen(id)) return fmt::format("disc {} is listed twice", id);
    constexpr std::uint64_t most_without_n = std::uint64_t{1} << 27;
    const std::uint64_t most_seen = scene_.n_discs > 0 ? scene_.n_discs : most_without_n;
    // Memory grows only with the ids found, because the scene's N may be wrong
    if (id >= seen_.size()) seen_.resize(std::min(most_seen, 2 * id + 64));
    if (id < seen_.size()) seen_[id] = true;
    n_seen_ += 1;
    return "";
}

void DiscReader::refuse(const Line& line, std::string text) {
    n_problems_ += 1;
    if (problems_.size() == most_problems) return;
    if (!has_lines_ && !text.starts_with("disc "))
        text = fmt::format("disc {}: {}", line.disc.id, text);
    problems_.push_back({place_, has_lines_ ? line.number : 0, std::move(text)});
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
        // `seen_` ends before the next id, so this id and all larger ones are missing
        if (id + 1 >= seen_.size()) id = scene_.n_discs - 1;
        if (++n_ranges > most_ranges)
            list += ", ...";
        else
            list += fmt::format("{}{}", list.empty() ? "" : ", ",
                                first == id ? fmt::format("{}", id)
                                            : fmt::format("{}-{}", first, id));
    }
    const std::uint64_t n_missing = scene_.n_discs - n_seen_;
    return fmt::format("{} of {} discs {} missing: {}", n_missing, scene_.n_discs,
                       n_missing == 1 ? "is" : "are", list);
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
