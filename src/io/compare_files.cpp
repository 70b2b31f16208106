// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "io/frame_file.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t rows_at_a_time = std::uint64_t{1} << 16;

/// Finds the first and the largest difference of numbers, and describes both in words.
class Differences {
public:
    /// `where()` returns a description of the place; it is called only if the numbers differ.
    template <class Where>
    void compare(double a, double b, const std::string& what, const Where& where) {
        // Equal, or both not a number. Zeros of either sign are equal, as in the state hash.
        if (a == b || (std::isnan(a) && std::isnan(b))) return;
        note(what, where(), fmt::format("{} and {}", a, b), std::fabs(a - b));
    }
    void compare_counts(std::size_t a, std::size_t b, const std::string& what) {
        compare(static_cast<double>(a), static_cast<double>(b), what, [] { return "the files"; });
    }
    void note(const std::string& what, const std::string& where, const std::string& values,
              double size) {
        if (result.is_same) result.first = fmt::format("{}, {}: {}", where, what, values);
        result.is_same = false;
        if (!(size <= result.largest)) {
            result.largest = size;
            result.largest_in = fmt::format("{}, {}", where, what);
        }
    }

    FileDifference result;
};

/// A column's name in messages. Positions are compared as stored, relative to the box's corner,
/// because subtracting the origin may lose bits.
std::string column_text(const FileSummary& summary, const std::string& column) {
    if (column == "x" && summary.origin[0] != 0) return "x from the left side";
    if (column == "y" && summary.origin[1] != 0) return "y from the bottom";
    return column;
}

/// `name` is the text before the number of a row in messages, such as "step 10, disc".
void compare_rows(const FrameFile& a, const FrameFile& b, std::size_t frame,
                  const std::string& name, Differences& differences) {
    const FileSummary &first = a.summary(), &second = b.summary();
    const std::uint64_t n = std::min(first.n_rows, second.n_rows);
    std::vector<std::string> columns;
    for (const std::string& column : first.columns) columns.push_back(column_text(first, column));
    Rows rows, others;
    for (std::uint64_t begin = 0; begin < n; begin += rows_at_a_time) {
        const std::uint64_t end = std::min(begin + rows_at_a_time, n);
        a.read(frame, begin, end, rows);
        b.read(frame, begin, end, others);
        for (std::uint64_t i = 0; i < end - begin; ++i)
            for (std::size_t k = 0; k < rows.size(); ++k) {
                const std::size_t place = second.place_of(first.columns[k]);
                if (place < others.size())
                    differences.compare(rows[k][i], others[place][i], columns[k],
                                        [&] { return fmt::format("{} {}", name, begin + i); });
            }
    }
}

void compare_frames(const FrameFile& a, const FrameFile& b, Differences& differences) {
    const auto &steps = a.summary().steps, &others = b.summary().steps;
    for (std::size_t frame = 0; frame < std::min(steps.size(), others.size()); ++frame) {
        differences.compare(static_cast<double>(steps[frame]), static_cast<double>(others[frame]),
                            "step", [&] { return fmt::format("frame {}", frame); });
        compare_rows(a, b, frame, fmt::format("step {}, disc", steps[frame]), differences);
    }
    differences.compare_counts(steps.size(), others.size(), "number of frames");
}

} // namespace

FileDifference compare_files(const std::string& a, const std::string& b) {
    const FrameFile first(a), second(b);
    first.check_numbers();
    second.check_numbers();
    const FileSummary &one = first.summary(), &other = second.summary();
    if (one.kind != other.kind) throw InputError({{b, 0, "is a file of another kind than " + a}});
    Differences differences;
    if (one.columns != other.columns)
        differences.note(
            "columns", "the files",
            fmt::format("{} and {}", fmt::join(one.columns, " "), fmt::join(other.columns, " ")),
            0);
    if (one.kind == FileKind::collisions) {
        compare_rows(first, second, 0, "collision", differences);
        differences.compare_counts(one.n_rows, other.n_rows, "number of collisions");
        return differences.result;
    }
    differences.compare_counts(one.n_rows, other.n_rows, "number of discs");
    for (const auto edge : {&Box::x, &Box::y})
        differences.compare(one.box.*edge, other.box.*edge, "box", [] { return "the files"; });
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}})
        differences.compare(one.origin[axis], other.origin[axis], "origin",
                            [] { return "the files"; });
    if (one.n_rows == other.n_rows) compare_frames(first, second, differences);
    if (differences.result.is_same && one.state_hash != other.state_hash)
        differences.note("state hash", "the files", one.state_hash + " and " + other.state_hash, 0);
    return differences.result;
}

} // namespace carrom
