// SPDX-License-Identifier: BSD-3-Clause
#include "stored_scene/discs_from.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "io/frame_file.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t block = 1 << 16;
constexpr std::array columns = {"x", "y", "vx", "vy"}; // a disc's line, behind its id

[[noreturn]] void refuse(const std::string& path, const std::string& text) {
    throw InputError({{path, 0, text}});
}

std::size_t frame_of(const std::string& path, const FileSummary& summary,
                     std::optional<std::int64_t> step) {
    if (summary.kind == FileKind::collisions)
        refuse(path, "is a log of collisions; discs.from takes a checkpoint or a trajectory");
    for (const char* column : columns)
        if (!summary.has(column))
            refuse(path, "its frames lack positions or velocities; discs.from takes both");
    if (summary.steps.empty()) refuse(path, "has no frame");
    if (!step) return summary.steps.size() - 1;
    const auto found = std::find(summary.steps.begin(), summary.steps.end(), *step);
    if (found == summary.steps.end())
        refuse(path, fmt::format("has no frame of step {}; its frames are of steps {} to {}", *step,
                                 summary.steps.front(), summary.steps.back()));
    return static_cast<std::size_t>(found - summary.steps.begin());
}

} // namespace

FileOfDiscs read_discs_from(const std::string& path, std::optional<std::int64_t> step,
                            const SideColumnSet& wanted) {
    const FrameFile file(path);
    file.check_numbers();
    const std::size_t frame = frame_of(path, file.summary(), step);
    FileOfDiscs discs;
    discs.n_discs = file.summary().n_rows;
    std::vector<std::size_t> places;
    for (const char* column : columns) places.push_back(file.summary().place_of(column));
    std::vector<std::string> names;
    wanted.for_each([&](SideColumn column) {
        if (!file.summary().has(info_of(column).shown)) return;
        places.push_back(file.summary().place_of(info_of(column).shown));
        names.push_back(fmt::format("\"{}\"", info_of(column).name));
    });
    if (!names.empty()) discs.columns = fmt::format("[{}]", fmt::join(names, ", "));
    auto out = std::back_inserter(discs.lines);
    Rows rows;
    for (std::uint64_t begin = 0; begin < discs.n_discs; begin += block) {
        const std::uint64_t end = std::min(begin + block, discs.n_discs);
        file.read(frame, begin, end, rows);
        for (std::uint64_t id = begin; id < end; ++id) {
            fmt::format_to(out, "{}", id);
            for (const std::size_t place : places)
                fmt::format_to(out, " {}", rows[place][id - begin]);
            discs.lines += '\n';
        }
    }
    return discs;
}

} // namespace carrom
