// SPDX-License-Identifier: BSD-3-Clause
// The lines of a list of discs, without what is no data.
//
// A file of discs (`discs.file`) may come from another program. So `#` begins a comment there,
// commas separate numbers as blanks do, and its first line may name the columns. Lines after a
// legacy header, and those of `discs.from`, have none of this. Price: one copy of each line that
// has commas.
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
    /// See LineReader. `begins_list`: the stream stands at the first line of the list.
    DataLines(std::istream& stream, const SceneParameters& scene, std::int64_t lines_before,
              std::uint64_t n_bytes = LineReader::no_limit, bool begins_list = true);

    /// The next line with data, commas replaced; false at the end. Of a line that is too long
    /// `reader().is_cut()` is true. `line` is valid until the next call.
    bool next(std::string_view& line);

    const LineReader& reader() const { return lines_; }

private:
    LineReader lines_;
    bool is_of_file_, may_have_names_;
    std::string text_;
    std::vector<std::string_view> words_;
};

/// `line` without a comment, in a file of discs.
std::string_view without_comment(std::string_view line);
/// Replaces the commas in `text`, so that it can be split at blanks. A field without a word becomes
/// a part of one that is no number.
void replace_commas(std::string& text);

/// Whether the words are names of columns: more than one, and none of them a number.
bool are_names(const std::vector<std::string_view>& words);
/// The column that a header line of another program calls so, in any case.
std::optional<DiscColumn> column_of(std::string_view name);

/// The columns of the scene's lines of discs, in their order. `discs.columns` names either all of
/// them, with "x", or those after `id x y vx vy`.
std::vector<DiscColumn> columns_of_lines(const SceneParameters& scene);
/// The columns' names, with blanks between them.
std::string names_of(const std::vector<DiscColumn>& columns);

} // namespace carrom
