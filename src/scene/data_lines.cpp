// SPDX-License-Identifier: BSD-3-Clause
#include "scene/data_lines.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "scene/disc_columns.hpp"
#include "scene/number.hpp"

namespace carrom {

DataLines::DataLines(std::istream& stream, const SceneParameters& scene, std::int64_t lines_before,
                     std::uint64_t n_bytes, bool begins_list)
    : lines_(stream, lines_before, n_bytes), is_of_file_(!scene.discs_file.empty()),
      may_have_names_(is_of_file_ && begins_list) {}

bool DataLines::next(std::string_view& line) {
    while (lines_.next(line)) {
        if (lines_.line_number() == 1 && line.starts_with(byte_order_mark))
            line.remove_prefix(byte_order_mark.size());
        const std::size_t length = line.size();
        if (is_of_file_) line = without_comment(line);
        const bool is_cut = lines_.is_cut() && line.size() == length;
        if (is_cut) return true;
        if (trimmed(line).empty()) continue;
        if (is_of_file_ && line.find(',') != std::string_view::npos) {
            text_ = line;
            replace_commas(text_);
            line = text_;
        }
        if (!std::exchange(may_have_names_, false)) return true;
        split_words(line, LineReader::longest_line, words_);
        if (!are_names(words_)) return true;
    }
    return false;
}

std::string_view without_comment(std::string_view line) { return line.substr(0, line.find('#')); }

void replace_commas(std::string& text) {
    bool is_empty = true; // whether the present field has only blanks so far
    for (char& c : text) {
        if (c == ',')
            c = std::exchange(is_empty, true) ? '?' : ' ';
        else if (c != ' ' && c != '\t')
            is_empty = false;
    }
}

bool are_names(const std::vector<std::string_view>& words) {
    return words.size() > 1 && std::ranges::none_of(words, [](std::string_view word) {
               return parse_double(word).has_value();
           });
}

std::optional<DiscColumn> column_of(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, DiscColumn>, 2> short_names = {
        {{"r", DiscColumn::radius}, {"m", DiscColumn::mass}}};
    std::string small;
    for (const char c : name)
        small += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const auto& [word, column] : short_names)
        if (small == word) return column;
    for (std::size_t k = 0; k < static_cast<std::size_t>(DiscColumn::first_side); ++k)
        if (small == name_of(static_cast<DiscColumn>(k))) return static_cast<DiscColumn>(k);
    for (const SideColumn column : all_side_columns)
        if (small == info_of(column).name || small == info_of(column).shown)
            return disc_column_of(column);
    return std::nullopt;
}

std::vector<DiscColumn> columns_of_lines(const SceneParameters& scene) {
    if (has_column(scene, DiscColumn::x)) return scene.disc_columns;
    std::vector<DiscColumn> columns = {DiscColumn::id, DiscColumn::x, DiscColumn::y, DiscColumn::vx,
                                       DiscColumn::vy};
    columns.insert(columns.end(), scene.disc_columns.begin(), scene.disc_columns.end());
    return columns;
}

std::string names_of(const std::vector<DiscColumn>& columns) {
    std::string text;
    for (const DiscColumn column : columns)
        text += (text.empty() ? "" : " ") + std::string(name_of(column));
    return text;
}

} // namespace carrom
