// SPDX-License-Identifier: BSD-3-Clause
// Reads those lines of a list of discs that contain data.
//
// A file of discs (`discs.file`) may come from another program. So in it `#` begins a comment,
// commas or blanks separate numbers, and the first line may name the columns. Lines after a legacy
// header, and lines of `discs.from`, contain only numbers and blanks. Cost: one copy of each line
// that has commas.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/line_reader.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

class DataLines {
public:
    /// `begins_list`: the stream is at the first line of the list. For the others see LineReader.
    DataLines(std::istream& stream, const SceneParameters& scene, std::int64_t lines_before,
              std::uint64_t n_bytes = LineReader::no_limit, bool begins_list = true);

    /// Reads the next line with data and replaces commas; returns false at the end. For a line that
    /// is too long, `reader().is_cut()` is true. `line` is valid until the next call.
    bool next(std::string_view& line);

    const LineReader& reader() const { return lines_; }

private:
    LineReader lines_;
    bool is_of_file_, may_have_names_;
    std::string text_;
    std::vector<std::string_view> words_;
};

/// A line of a file of discs without its comment.
std::string_view without_comment(std::string_view line);
/// Replaces the commas in `text`, so that it can be split at blanks. The comma after an empty field
/// becomes "?", which is an invalid number.
void replace_commas(std::string& text);

/// Whether the words are column names: there are several words, and none of them is a number.
bool are_names(const std::vector<std::string_view>& words);
/// The column that a word of a header line names, such as "radius" or "R"; nothing if no column has
/// this name. The case of letters does not matter.
std::optional<DiscColumn> column_of(std::string_view name);

/// The columns of the scene's lines of discs, in their order. `discs.columns` names either all
/// columns, including "x", or only those after `id x y vx vy`.
std::vector<DiscColumn> columns_of_lines(const SceneParameters& scene);
/// The names of the columns, separated by blanks.
std::string names_of(const std::vector<DiscColumn>& columns);

} // namespace carrom
