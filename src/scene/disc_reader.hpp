// SPDX-License-Identifier: BSD-3-Clause
// Reads discs from lines of text, "id x y vx vy" or other columns (`discs.columns`; those beyond
// places and velocities are checked here and kept by read_disc_columns) in any order of ids, in
// bounded chunks, so that one rank can read more than it could hold. Takes up to N
// bits to see that every id comes once, and less than a microsecond a line, which threads share:
// lines are parsed by all of them, and then ids are noted in the order of lines. Without a column
// of ids, discs are numbered in the order of lines.
// Places in lines are those of users (scene/places.hpp); in the lines of `discs.from` they count
// from the corner of the box already.
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
    static constexpr std::size_t most_problems = 20; ///< these are listed; the rest are counted
    static constexpr std::size_t most_wrong_lines =
        1'000'000; ///< reading ends there, because this is no list of discs

    /// Calls work(first, last) for parts that are 0 .. n - 1 together, on any threads.
    using InParts =
        std::function<void(std::size_t n, const std::function<void(std::size_t, std::size_t)>&)>;

    /// Reads `stream`, which stands at the first disc; `stream` and `scene` must outlive the
    /// reader.
    DiscReader(std::istream& stream, const SceneParameters& scene);

    /// The lines of a file that begin in some of its bytes.
    struct Part {
        bool is_first = true;
        std::uint64_t n_bytes = 0;
    };
    /// Reads a part, at whose first line `stream` stands. Whether ids come once is not its matter.
    DiscReader(std::istream& stream, const SceneParameters& scene, const Part& part);

    /// Replaces `chunk` by the next discs, at most `limit`; false if none are left.
    bool read(
        std::vector<InputDisc>& chunk, std::size_t limit,
        const InParts& in_parts = [](std::size_t n, const auto& work) { work(0, n); });

    /// All errors of the lines, and ids that never came. To be called after `read` has
    /// returned false, but not for a part: it does not know the numbers of lines.
    std::vector<Problem> problems() const;
    /// Whether no line of a part is wrong as far as it was read.
    bool is_flawless() const {
        return n_problems_ == 0 && !lines_.reader().is_endless() && !lines_.reader().has_failed();
    }

private:
    /// A line, and what is in it whatever other lines have.
    struct Line {
        std::size_t begin = 0, end = 0; ///< in `text_`
        std::int64_t number = 0;
        bool is_cut = false;
        bool has_number = false; ///< of a disc; other faults are looked for only then
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
    std::string note_id(const Line& line);
    void refuse(const Line& line, std::string text);
    std::string missing_ids() const;
    std::uint64_t most_discs()
        const; ///< N, or what it can be at most where the scene has no right one

    const SceneParameters& scene_;
    SpeciesTable species_;
    std::string place_;
    bool has_lines_; ///< false for `discs.from`, whose lines nobody sees: problems name the discs
    std::vector<DiscColumn> columns_;
    std::optional<std::size_t> place_of_id_; ///< in a line
    DataLines lines_;
    DiscId next_id_ = 0; ///< of lines without ids
    bool are_ids_noted_ = true;
    std::vector<bool> seen_; ///< by id, as far as ids have come
    std::uint64_t n_seen_ = 0;
    std::vector<char> text_;
    std::vector<Line> taken_;
    std::vector<Problem> problems_;
    std::uint64_t n_problems_ = 0;
};

/// Everything wrong with the lines of `stream`, as DiscReader has it, and keeps no disc. The scene
/// may have problems of its own: without a number of discs (0) none is missing, without a box (0)
/// none is outside.
std::vector<Problem> disc_line_problems(std::istream& stream, const SceneParameters& scene);

} // namespace carrom
