// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/subcommands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "apps/shell/codes_of_files.hpp"
#include "io/checkpoint.hpp"
#include "io/frame_file.hpp"
#include "parallel/agreement.hpp"
#include "run/start/restart.hpp"
#include "stored_scene/stored_scene.hpp"

namespace carrom {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Describes a number of the disc that no run can produce; empty if all its numbers are possible.
std::string flaw_of(const DiscState& disc, double radius, const CheckpointHeader& header,
                    const Extent& box) {
    const double clock = header.clock();
    if (disc.has_departed())
        return disc.vx == 0 && disc.vy == 0
                   ? ""
                   : fmt::format("disc {} has left the box, yet moves", disc.id);
    const DiscState shown = header.frame.in_box(disc, clock);
    const double x = shown.x, y = shown.y;
    // A disc may be slightly beyond a wall within a micro-step, or because L - r is rounded.
    const double slack = 1e-6 * header.radius + 0x1p-50 * header.box().longest();
    const double margin = radius - slack;
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(disc.vx) ||
        !std::isfinite(disc.vy))
        return fmt::format("disc {} has a number that is not finite", disc.id);
    if (x < box.x_low + margin || x > box.x_high - margin || y < box.y_low + margin ||
        y > box.y_high - margin)
        return fmt::format("disc {} is outside the box, at ({}, {}) from its corner", disc.id, x,
                           y);
    if (!(disc.tau >= 0 && disc.tau <= clock))
        return fmt::format("disc {} has the time {}, and it is {} now", disc.id, disc.tau, clock);
    return {};
}

/// The box for `flaw_of`: centres must be at least a radius inside of its sides.
/// **Not collective.**
Extent room_of(const CheckpointHeader& header, const Effects& effects) {
    Extent box = extent_at(effects, header.box(), static_cast<double>(header.step));
    const auto make_room = [&](std::size_t side, double& line, double outwards) {
        if (effects.boundaries[side].kind == BoundaryKind::open)
            line = outwards * infinity; // open side: discs may be leaving
        if (effects.boundaries[side].is_periodic())
            line += outwards * header.radius; // periodic side: centres may be anywhere in the box
    };
    make_room(0, box.x_low, -1);
    make_room(1, box.x_high, 1);
    make_room(2, box.y_low, -1);
    make_room(3, box.y_high, 1);
    return box;
}

/// Checks the numbers of the discs. `read_checkpoint` checks the bytes and the state hash.
/// **Collective.**
void verify_checkpoint(const std::string& path, const Communicator& ranks) {
    const Checkpoint checkpoint = read_checkpoint(path, ranks);
    const CheckpointHeader& header = checkpoint.header;
    const Effects effects = scene_of(header, {}).effects; // throws if the scene cannot be read
    const Extent room = room_of(header, effects);
    const SpeciesTable species(effects.species, header.radius);
    std::string flaw;
    std::uint64_t sums[] = {0, 0};
    for (std::size_t i = 0; i < checkpoint.discs.size(); ++i) {
        const DiscState& disc = checkpoint.discs[i];
        const double radius = header.columns.has(SideColumn::swapped_radius)
                                  ? checkpoint.columns[SideColumn::swapped_radius][i]
                                  : species.of(disc.id).radius;
        if (flaw.empty()) flaw = flaw_of(disc, radius, header, room);
        header.columns.for_each([&](SideColumn column) {
            if (flaw.empty() && !std::isfinite(checkpoint.columns[column][i]))
                flaw = fmt::format("disc {} has a number that is not finite", disc.id);
        });
        sums[0] += disc.wall_collisions;
        sums[1] += disc.pair_collisions;
    }
    ranks.sum(sums);
    if (flaw.empty() &&
        (sums[0] != header.wall_collisions || sums[1] != 2 * header.pair_collisions))
        flaw = "the discs' collisions do not add up";
    agree(ranks, flaw.empty(), path + ": " + flaw, ExitCode::bad_input);
}

void refuse(const std::string& path, const std::string& text) {
    throw InputError({{path, 0, text}});
}

/// Reads rows of a file. Columns are accessed by name; a column that the file lacks has only zeros.
class NamedRows {
public:
    explicit NamedRows(const FrameFile& file) : file_(file) {}
    void read(std::size_t frame, std::uint64_t begin) {
        const std::uint64_t end = std::min(begin + rows_at_a_time, file_.summary().n_rows);
        file_.read(frame, begin, end, rows_);
        size_ = end - begin;
    }
    std::size_t size() const { return size_; }
    double operator()(std::size_t i, std::string_view column) const {
        const std::size_t place = file_.summary().place_of(column);
        return place < rows_.size() ? rows_[place][i] : 0;
    }
    bool are_finite(std::size_t i) const {
        return std::all_of(rows_.begin(), rows_.end(),
                           [i](const auto& column) { return std::isfinite(column[i]); });
    }

private:
    const FrameFile& file_;
    Rows rows_;
    std::size_t size_ = 0;
};

/// Whether a run can produce a disc at this position. A disc leaves through an open side when its
/// centre is a radius beyond it, and then stays at rest. In the time-stepped method a disc that a
/// collision has pushed out may fly on until the end of the micro-step.
bool is_possible(const NamedRows& rows, std::size_t i, const FileSummary& summary, const Box& box) {
    if (!rows.are_finite(i)) return false;
    if (!summary.has("x")) return true;
    const double x = rows(i, "x"), y = rows(i, "y"), vx = rows(i, "vx"), vy = rows(i, "vy");
    const double rounding = summary.bytes_per_number == 4 ? 0x1p-22 : 0x1p-50;
    const double reach = summary.radius + rounding * (box.longest() + summary.radius);
    const std::array<double, 4> beyond = {-x, x - box.x, -y, y - box.y}, rate = {-vx, vx, -vy, vy};
    const bool is_at_rest = summary.has("vx") && vx == 0 && vy == 0;
    bool has_left = false;
    for (std::size_t side = 0; side < beyond.size(); ++side)
        has_left |= summary.open_boundaries[side] && is_at_rest && beyond[side] > 0 &&
                    beyond[side] <= reach; // small discs leave closer to the side than large ones
    for (std::size_t side = 0; side < beyond.size(); ++side) {
        if (beyond[side] <= summary.amplitudes[side]) continue;
        if (!summary.open_boundaries[side]) return false;
        // Without velocities it is unknown how far the disc may have flown. A disc that is pushed
        // out over a corner leaves through one side, so it may be far beyond the other one.
        const bool is_bounded = summary.has("vx") && !has_left;
        if (is_bounded && beyond[side] > reach + std::max(0.0, rate[side])) return false;
    }
    return true;
}

void verify_frames(const FrameFile& file, const std::string& path) {
    const FileSummary& summary = file.summary();
    NamedRows rows(file);
    for (std::size_t frame = 0; frame < summary.steps.size(); ++frame) {
        if (frame > 0 && summary.steps[frame] <= summary.steps[frame - 1])
            refuse(path, fmt::format("frame {} goes back in time", frame));
        for (std::uint64_t begin = 0; begin < summary.n_rows; begin += rows_at_a_time) {
            rows.read(frame, begin);
            for (std::size_t i = 0; i < rows.size(); ++i) {
                if (!is_possible(rows, i, summary, summary.boxes[frame]))
                    refuse(path, fmt::format("disc {} is outside the box or not finite at step {}",
                                             begin + i, summary.steps[frame]));
            }
        }
    }
}

/// Whether there can be a disc with this id. Any id is possible if the file lacks the number of
/// discs, as files of other programs may.
bool is_disc(double id, const FileSummary& summary) {
    return id >= 0 && (summary.n_discs == 0 || id < static_cast<double>(summary.n_discs));
}

void verify_log(const FrameFile& file, const std::string& path) {
    const FileSummary& summary = file.summary();
    NamedRows rows(file);
    double last_step = 0, last_time = 0;
    for (std::uint64_t begin = 0; begin < summary.n_rows; begin += rows_at_a_time) {
        rows.read(0, begin);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const double step = rows(i, "step"), time = rows(i, "time"), p = rows(i, "p"),
                         q = rows(i, "q");
            if (!rows.are_finite(i))
                refuse(path,
                       fmt::format("collision {} has a number that is not finite", begin + i));
            if (step < last_step || time < last_time)
                refuse(path, fmt::format("goes back in time at step {}", step));
            if (!is_disc(p, summary) || !(q == -1 || is_disc(q, summary)) || p == q)
                refuse(path, fmt::format("has a collision of {} and {}", p, q));
            last_step = step;
            last_time = time;
        }
    }
}

std::string gaps_text(const std::vector<std::int64_t>& gaps) {
    std::string text;
    for (std::size_t k = 0; k + 1 < gaps.size(); k += 2)
        text += fmt::format("{}{} to {}", k == 0 ? "" : ", ", gaps[k], gaps[k + 1]);
    return text;
}

ExitCode verify(const std::string& path, const Communicator& ranks) {
    const bool is_checkpoint = check_damage(path, ranks).has_value();
    int code = static_cast<int>(ExitCode::success);
    std::string verdict = "whole";
    let_root(ranks, [&] {
        const FrameFile file(path);
        const FileSummary& summary = file.summary();
        file.check_numbers();
        if (is_checkpoint != (summary.kind == FileKind::checkpoint))
            refuse(path, "is damaged: now it is a checkpoint, and now it is none");
        if (summary.kind == FileKind::trajectory) verify_frames(file, path);
        if (summary.kind == FileKind::collisions) verify_log(file, path);
        if (!summary.has_checksums) {
            code = static_cast<int>(no_checksums);
            verdict = "no checksums, so nobody knows whether it is as it was written; its numbers "
                      "are finite, and its discs ";
            verdict += summary.kind == FileKind::collisions ? "exist" : "inside the box";
        } else if (!summary.gaps.empty()) {
            code = static_cast<int>(incomplete);
            verdict = "as it was written, and without the collisions of steps " +
                      gaps_text(summary.gaps);
        }
    });
    ranks.broadcast(code);
    if (is_checkpoint) verify_checkpoint(path, ranks);
    if (ranks.is_root()) fmt::print("{}: {}\n", path, verdict);
    return static_cast<ExitCode>(code);
}

} // namespace

Subcommand verify_subcommand() {
    constexpr const char* examples = R"(Examples:
  carrom verify kept/checkpoint-000000001000.h5
  mpirun -np 4 carrom verify LARGE_CHECKPOINT.h5)";
    const auto path = std::make_shared<std::string>();
    const auto action = [path](std::vector<Problem>&) -> Action {
        return {[path](const Communicator& ranks) { return verify(*path, ranks); }};
    };
    return {"verify",
            "Check a file: every byte, the state hash, the discs; exit code 2 if it is damaged, 5 "
            "if it "
            "has no checksums, 6 if a log has a gap",
            examples,
            {{"FILE", "", help_of_file, path.get(), true}},
            action};
}

} // namespace carrom
