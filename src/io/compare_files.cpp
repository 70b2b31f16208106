// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "io/frame_file.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t rows_at_a_time = std::uint64_t{1} << 16;

/// Collects differences of numbers; the first one told is the first one found.
class Differences {
public:
    void compare(double a, double b, const char* field, const std::string& where) {
        // The same number, or both not a number; -0 is 0 as in the state hash.
        if (a == b || (std::isnan(a) && std::isnan(b))) return;
        note(field, where, fmt::format("{} and {}", a, b), std::fabs(a - b));
    }
    void compare_counts(std::uint64_t a, std::uint64_t b, const char* field,
                        const std::string& where) {
        if (a != b)
            note(field, where, fmt::format("{} and {}", a, b),
                 static_cast<double>(a > b ? a - b : b - a));
    }
    void note(const std::string& field, const std::string& where, const std::string& values,
              double size) {
        if (result.is_same) result.first = fmt::format("{}, {}: {}", where, field, values);
        result.is_same = false;
        if (!(size <= result.largest)) {
            result.largest = size;
            result.largest_in = fmt::format("{}, {}", where, field);
        }
    }

    FileDifference result;
};

void compare_frames(const FrameFile& a, const FrameFile& b, Differences& differences) {
    const FileSummary &first = a.summary(), &second = b.summary();
    const std::size_t n_frames = std::min(first.steps.size(), second.steps.size());
    std::vector<FrameRow> rows, others;
    for (std::size_t frame = 0; frame < n_frames; ++frame) {
        differences.compare_counts(static_cast<std::uint64_t>(first.steps[frame]),
                                   static_cast<std::uint64_t>(second.steps[frame]), "step",
                                   fmt::format("frame {}", frame));
        for (std::uint64_t begin = 0; begin < first.n_discs; begin += rows_at_a_time) {
            const std::uint64_t end = std::min(begin + rows_at_a_time, first.n_discs);
            a.read(frame, begin, end, rows);
            b.read(frame, begin, end, others);
            for (std::size_t i = 0; i < rows.size(); ++i) {
                const FrameRow &p = rows[i], &q = others[i];
                if (std::bit_cast<std::array<char, sizeof p>>(p) ==
                    std::bit_cast<std::array<char, sizeof q>>(q))
                    continue;
                const std::string where = fmt::format("step {}, disc {}", first.steps[frame],
                                                      begin + i);
                differences.compare(p.x, q.x, "x", where);
                differences.compare(p.y, q.y, "y", where);
                differences.compare(p.vx, q.vx, "vx", where);
                differences.compare(p.vy, q.vy, "vy", where);
                differences.compare(p.angular_velocity, q.angular_velocity, "angular velocity",
                                    where);
                differences.compare_counts(p.wall_collisions, q.wall_collisions, "wall collisions",
                                           where);
                differences.compare_counts(p.pair_collisions, q.pair_collisions, "pair collisions",
                                           where);
            }
        }
    }
    differences.compare_counts(first.steps.size(), second.steps.size(), "number of frames",
                               "the files");
}

void compare_logs(const FrameFile& a, const FrameFile& b, Differences& differences) {
    const std::uint64_t n = std::min(a.summary().n_logged, b.summary().n_logged);
    std::vector<LoggedCollision> rows, others;
    for (std::uint64_t begin = 0; begin < n; begin += rows_at_a_time) {
        const std::uint64_t end = std::min(begin + rows_at_a_time, n);
        a.read(begin, end, rows);
        b.read(begin, end, others);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const LoggedCollision &p = rows[i], &q = others[i];
            const bool is_same = p.step == q.step && p.p == q.p && p.q == q.q && p.time == q.time &&
                                 p.impulse == q.impulse;
            if (is_same) continue;
            const std::string where = fmt::format("collision {}", begin + i);
            differences.compare_counts(static_cast<std::uint64_t>(p.step),
                                       static_cast<std::uint64_t>(q.step), "step", where);
            differences.compare(p.time, q.time, "time", where);
            differences.compare_counts(static_cast<std::uint64_t>(p.p),
                                       static_cast<std::uint64_t>(q.p), "p", where);
            differences.compare(static_cast<double>(p.q), static_cast<double>(q.q), "q", where);
            differences.compare(p.impulse, q.impulse, "impulse", where);
        }
    }
    differences.compare_counts(a.summary().n_logged, b.summary().n_logged, "number of collisions",
                               "the files");
}

} // namespace

FileDifference compare_files(const std::string& a, const std::string& b) {
    const FrameFile first(a), second(b);
    if (first.summary().kind != second.summary().kind)
        throw InputError({{b, 0, "is a file of another kind than " + a}});
    Differences differences;
    if (first.summary().kind == FileKind::collisions) {
        compare_logs(first, second, differences);
        return differences.result;
    }
    differences.compare_counts(first.summary().n_discs, second.summary().n_discs, "number of discs",
                               "the files");
    differences.compare(first.summary().box_size, second.summary().box_size, "box", "the files");
    if (first.summary().n_discs == second.summary().n_discs)
        compare_frames(first, second, differences);
    if (differences.result.is_same && first.summary().state_hash != second.summary().state_hash)
        differences.note("state hash", "the files",
                         first.summary().state_hash + " and " + second.summary().state_hash, 0);
    return differences.result;
}

} // namespace carrom
