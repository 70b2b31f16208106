// SPDX-License-Identifier: BSD-3-Clause
#include "scene/disc_file.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "scene/data_lines.hpp"
#include "scene/disc_columns.hpp"
#include "scene/limits.hpp"
#include "scene/number.hpp"

namespace carrom {

namespace {

using Columns = std::vector<DiscColumn>;

constexpr std::string_view expected = "expected lines `id x y vx vy`, or a first line that names "
                                      "the columns";

/// Returns an error message if the first line shows that the file has another format, such as HDF5;
/// empty if the file may be a list of discs.
std::string other_format(std::string_view line) {
    if (line.starts_with("\x89HDF"))
        return "is an HDF5 file; try: discs.from, which takes checkpoints and trajectories";
    if (line.find('\0') != std::string_view::npos)
        return fmt::format("holds bytes that are no text; {}", expected);
    if (line.starts_with("ITEM:")) return fmt::format("looks like a LAMMPS dump; {}", expected);
    return {};
}

/// The columns that the words name. Unknown names are added to `unknown`.
Columns columns_named(const std::vector<std::string_view>& words, std::string& unknown) {
    Columns columns;
    for (const std::string_view word : words) {
        const auto column = column_of(word);
        if (column)
            columns.push_back(*column);
        else
            unknown += (unknown.empty() ? "" : ", ") + in_quotes(word);
    }
    return columns;
}

bool has(const Columns& columns, DiscColumn column) {
    return std::ranges::find(columns, column) != columns.end();
}

/// The names of all possible columns.
std::string all_names() {
    Columns all;
    for (std::size_t k = 0; k < static_cast<std::size_t>(DiscColumn::first_side); ++k)
        all.push_back(static_cast<DiscColumn>(k));
    for (const SideColumn column : given_side_columns) all.push_back(disc_column_of(column));
    return names_of(all);
}

class Survey {
public:
    Survey(std::istream& file, const SceneParameters& scene)
        : scene_(scene), place_(discs_path(scene)), lines_(file, 0) {}

    SurveyOfDiscs survey() {
        std::string_view line;
        bool has_data = false;
        while (!has_data && found_.problems.empty() && lines_.next(line)) has_data = take(line);
        if (!found_.problems.empty()) return std::move(found_);
        if (columns_) set_columns();
        if (scene_.n_discs == 0) count(has_data);
        return std::move(found_);
    }

private:
    void refuse(std::int64_t line, std::string text) {
        found_.problems.push_back({place_, line, std::move(text)});
    }

    /// Handles a line before the data, or the first line of data. Returns true for a line of data.
    bool take(std::string_view line) {
        if (lines_.line_number() == 1) {
            if (line.starts_with(byte_order_mark)) line.remove_prefix(byte_order_mark.size());
            if (const std::string text = other_format(line); !text.empty()) {
                refuse(1, text);
                return false;
            }
        }
        const std::string_view data = without_comment(line);
        const bool is_comment = trimmed(data).empty();
        std::string text{is_comment ? line.substr(data.size()) : data};
        text.erase(0, text.find_first_not_of('#'));
        replace_commas(text);
        std::vector<std::string_view> words;
        split_words(text, LineReader::longest_line, words);
        if (is_comment) {
            take_comment(words);
        } else if (!is_header_taken_ && are_names(words)) {
            is_header_taken_ = true;
            take_names(words);
        } else if (!lines_.is_cut()) {
            if (!columns_) guess_columns(words);
            return true;
        } else {
            return true;
        }
        return false;
    }

    /// Uses a comment as the header line if all its words name columns, x and y among them.
    void take_comment(const std::vector<std::string_view>& words) {
        std::string unknown;
        const Columns columns = columns_named(words, unknown);
        if (unknown.empty() && has(columns, DiscColumn::x) && has(columns, DiscColumn::y))
            check_columns(columns);
    }

    void take_names(const std::vector<std::string_view>& words) {
        std::string unknown;
        const Columns columns = columns_named(words, unknown);
        if (!unknown.empty())
            return refuse(lines_.line_number(),
                          fmt::format("the header line names {}; columns of discs are: {}", unknown,
                                      all_names()));
        if (!has(columns, DiscColumn::x) || !has(columns, DiscColumn::y))
            return refuse(lines_.line_number(), "the header line must name x and y");
        check_columns(columns);
    }

    void check_columns(const Columns& columns) {
        columns_ = columns;
        Columns sorted = columns;
        std::ranges::sort(sorted);
        if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
            return refuse(lines_.line_number(),
                          fmt::format("the header line names {} twice", name_of(*twice)));
        if (scene_.disc_columns.empty() || scene_.disc_columns == columns) return;
        const bool is_same = std::ranges::all_of(
            columns_of_lines(scene_), [&](DiscColumn column) { return has(columns, column); });
        if (!is_same || columns.size() != columns_of_lines(scene_).size())
            refuse(lines_.line_number(),
                   fmt::format("the header line names '{}', and the scene's discs.columns means "
                               "'{}'; leave discs.columns out",
                               names_of(columns), names_of(columns_of_lines(scene_))));
    }

    /// Guesses from the number of words in a line which columns precede those of `discs.columns`.
    void guess_columns(const std::vector<std::string_view>& words) {
        if (std::ranges::any_of(scene_.disc_columns,
                                [](DiscColumn column) { return column < DiscColumn::radius; }))
            return; // the scene names all columns, so nothing has to be guessed
        const std::size_t n_behind = scene_.disc_columns.size();
        if (words.size() < n_behind + 2 || words.size() > n_behind + 4) return;
        const std::size_t n = words.size() - n_behind;
        Columns columns;
        if (n == 3) columns.push_back(DiscColumn::id);
        columns.insert(columns.end(), {DiscColumn::x, DiscColumn::y});
        if (n == 4) columns.insert(columns.end(), {DiscColumn::vx, DiscColumn::vy});
        columns.insert(columns.end(), scene_.disc_columns.begin(), scene_.disc_columns.end());
        columns_ = columns;
    }

    void set_columns() {
        if (*columns_ == columns_of_lines(scene_)) return;
        std::string list;
        for (const DiscColumn column : *columns_)
            list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", name_of(column));
        found_.settings.push_back(fmt::format("discs.columns=[{}]", list));
    }

    /// Counts the lines with data. `has_data`: the first of them has already been read.
    void count(bool has_data) {
        std::uint64_t n = has_data ? 1 : 0;
        for (std::string_view line; n <= largest_count && lines_.next(line);)
            n += trimmed(without_comment(line)).empty() ? 0 : 1;
        if (n == 0)
            refuse(0, "has no discs");
        else if (n > largest_count)
            refuse(0, fmt::format("has more than {} lines of discs, the most that are possible",
                                  largest_count));
        else
            found_.settings.push_back(fmt::format("discs.count={}", n));
    }

    const SceneParameters& scene_;
    std::string place_;
    LineReader lines_;
    bool is_header_taken_ = false;
    std::optional<Columns> columns_; ///< set when the columns are named or guessed
    SurveyOfDiscs found_;
};

} // namespace

SurveyOfDiscs survey_discs(std::istream& file, const SceneParameters& scene) {
    return Survey(file, scene).survey();
}

} // namespace carrom
