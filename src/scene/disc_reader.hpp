// SPDX-License-Identifier: BSD-3-Clause
// Reads discs from lines of text in bounded chunks, so that one rank can read more discs than fit
// into its memory.
//
// A line is "id x y vx vy", or has other columns (`discs.columns`). Ids may be in any order.
// Columns beyond positions and velocities are only checked here; read_disc_columns reads them. The
// test that every id occurs once needs up to one bit per disc. Reading takes less than 1 us per
// line. Threads parse the lines of a chunk; then ids are recorded in the order of lines. Without a
// column of ids, discs are numbered in the order of lines. Positions are relative to the users'
// origin (scene/places.hpp), or in lines of `discs.from` to the lower left corner of the box.
//
// Problems are collected, not thrown, so that one pass over a file finds them all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.hpp"
#include "scene/data_lines.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

class DiscReader {
public:
    /// The first problems, up to this number, are listed; further ones are only counted
    static constexpr std::size_t most_problems = 20;
    static constexpr std::size_t most_wrong_lines =
        1'000'000; ///< reading ends after this many problems, because the file is
                   ///< probably not a list of discs

    /// A function that calls work(first, last) for ranges [first, last) that together cover
    /// 0 .. n - 1, on any threads.
    using InParts =
        std::function<void(std::size_t n, const std::function<void(std::size_t, std::size_t)>&)>;

    /// Reads `stream`, which is at the first disc; `stream` and `scene` must outlive the reader.
    DiscReader(std::istream& stream, const SceneParameters& scene);

    /// A range of bytes of a file; the lines that begin in it belong to the part.
    struct Part {
        bool is_first = true;
        std::uint64_t n_bytes = 0;
    };
    /// Reads a part; `stream` is at its first line. Does not test that ids occur once.
    DiscReader(std::istream& stream, const SceneParameters& scene, const Part& part);

    /// Replaces the contents of `chunk` by up to `limit` further discs; false if no disc is left.
    bool read(
        std::vector<InputDisc>& chunk, std::size_t limit,
        const InParts& in_parts = [](std::size_t n, const auto& work) { work(0, n); });

    /// The first errors of lines, the number of further errors, and missing ids. Call it after
    /// `read` has returned false. Not for parts of a file, whose line numbers are unknown.
    std::vector<Problem> problems() const;
    /// Whether a part has had no wrong line and no read error so far.
    bool is_flawless() const {
        return n_problems_ == 0 && !lines_.reader().is_endless() && !lines_.reader().has_failed();
    }

private:
    /// A line and the results of parsing it, which do not depend on other lines.
    struct Line {
        std::size_t begin = 0, end = 0; ///< range of the line in `text_`
        std::int64_t number = 0;
        bool is_cut = false;
        /// Whether the line has a valid id; other errors are reported only in this case
        bool has_number = false;
        InputDisc disc;
        std::string fault;
    };

    bool take_lines(std::size_t limit);
    void parse(Line& line, std::vector<std::string_view>& words) const;
    void judge(Line& line, std::vector<InputDisc>& chunk);
    std::string_view text_of(const Line& line) const {
        return std::string_view(text_.data() + line.begin, line.end - line.begin);
    }
    bool has_seen(DiscId id) const { return id < seen_.size() && seen_[id]; }
    std::string record_id(const Line& line);
    void refuse(const Line& line, std::string text);
    std::string missing_ids() const;
    std::uint64_t most_discs()
        const; ///< N, or an upper bound if the scene has no valid number of discs

    const SceneParameters& scene_;
    SpeciesTable species_;
    std::string place_;
    /// False for `discs.from`: a user cannot see these lines, so problems contain the ids of discs
    /// instead of line numbers
    bool has_lines_;
    std::vector<DiscColumn> columns_;
    std::optional<std::size_t> place_of_id_; ///< index of the id among the words of a line, if any
    DataLines lines_;
    DiscId next_id_ = 0; ///< the next id, for lines without ids
    bool are_ids_noted_ = true;
    std::vector<bool> seen_; ///< whether each id has occurred; grows as needed
    std::uint64_t n_seen_ = 0;
    std::vector<char> text_;
    std::vector<Line> taken_;
    std::vector<Problem> problems_;
    std::uint64_t n_problems_ = 0;
};

/// The problems that DiscReader finds in the lines of `stream`; discs are not kept. The scene
/// may have problems itself. If its number of discs is 0, missing discs are not reported; if its
/// box is 0, positions outside of the box are not reported.
std::vector<Problem> disc_line_problems(std::istream& stream, const SceneParameters& scene);

} // namespace carrom
