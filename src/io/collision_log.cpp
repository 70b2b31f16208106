// SPDX-License-Identifier: BSD-3-Clause
#include "io/collision_log.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "io/checked_dataset.hpp"
#include "io/h5md.hpp"
#include "io/segmented_file.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace {

constexpr std::size_t rows_at_once = 1 << 18;

/// The columns of the file, in the order of the members of LoggedCollision.
constexpr std::array column_names = {"step", "time", "p", "q", "impulse"};
using Words = std::array<std::uint64_t, column_names.size()>;
constexpr std::size_t time_column = 1, impulse_column = 4; // the columns of real numbers

constexpr const char* last_step_path = "/carrom/collisions/last_step";

std::vector<RecordedColumn> recorded_columns(const RecordedSystem& system) {
    std::vector<RecordedColumn> recorded;
    for (const char* name : column_names)
        recorded.push_back({std::string(h5md::collisions_path) + name, H5T_STD_I64LE, {}});
    recorded[time_column].type = recorded[impulse_column].type = H5T_IEEE_F64LE;
    recorded[time_column].unit = h5md::unit_of(system, 0, 1);
    return recorded;
}

void write_structure(hid_t file, const RecordedSystem& system, const LoggedSteps& steps) {
    h5md::write_system(file, system);
    h5md::write_bodies(file, system);
    h5::write_column(file, "/particles/discs/box/edges", h5md::edges_of(system.box));
    static_cast<void>(h5::create_group(file, "/carrom/collisions"));
    h5::write_scalar(file, last_step_path, steps.last);
    if (!steps.gaps.empty()) h5::write_column(file, h5md::gaps_path, steps.gaps);
}

/// Reads which steps, up to `step`, a log has. Logs of version 0.2 lack their last step and count
/// as complete.
LoggedSteps steps_at(hid_t file, std::int64_t step) {
    LoggedSteps steps{step, {}};
    if (h5::has(file, last_step_path)) h5::read_scalar(file, last_step_path, steps.last);
    std::vector<std::int64_t> there;
    if (h5::has(file, h5md::gaps_path))
        there = h5::read_column<std::int64_t>(file, h5md::gaps_path);
    for (std::size_t k = 0; k + 1 < there.size() && there[k] <= step; k += 2)
        steps.gaps.insert(steps.gaps.end(), {there[k], std::min(there[k + 1], step)});
    if (steps.last < step) steps.gaps.insert(steps.gaps.end(), {steps.last + 1, step});
    steps.last = step;
    return steps;
}

void write_rows(SegmentedFile& file, std::span<const LoggedCollision> rows) {
    while (!rows.empty()) {
        const auto some = rows.first(std::min<std::uint64_t>(rows.size(), file.room()));
        std::vector<std::uint64_t> numbers(some.size());
        for (std::size_t k = 0; k < column_names.size(); ++k) {
            for (std::size_t i = 0; i < some.size(); ++i)
                numbers[i] = std::bit_cast<Words>(some[i])[k];
            file.write(k, std::as_bytes(std::span(numbers)));
        }
        file.add(some.size());
        rows = rows.subspan(some.size());
    }
}

} // namespace

CollisionLog::CollisionLog(const std::string& path, const RecordedSystem& system,
                           const Communicator& communicator)
    : file_(std::make_unique<SegmentedFile>(
          path, recorded_columns(system),
          [this, system](hid_t index) { write_structure(index, system, steps_); }, communicator)),
      communicator_(communicator) {}

CollisionLog::~CollisionLog() = default;

void CollisionLog::begin() {
    steps_ = {};
    file_->begin();
}

bool CollisionLog::go_on(std::int64_t step) {
    steps_ = {step, {}}; // for the case that there is no file
    if (step > 0) steps_.gaps = {1, step};
    return file_->go_on(std::string(h5md::collisions_path) + column_names[0], step,
                        [&](hid_t file) {
                            if (!h5::has(file, "/carrom/collisions"))
                                throw FileError("is no log of collisions");
                            if (h5::has(file, last_step_path))
                                h5::read_scalar(file, last_step_path, recorded_before_);
                            steps_ = steps_at(file, step);
                        });
}

void CollisionLog::commit() { file_->commit(); }

void CollisionLog::append(std::span<const LoggedCollision> mine, std::int64_t step) {
    steps_.last = step;
    if (communicator_.sum(std::uint64_t{mine.size()}) == 0) return;
    const auto write = [&](std::span<const LoggedCollision> rows) {
        file_->attempt([&] { write_rows(*file_, rows); });
    };
    stream_to_root(communicator_, mine, write, rows_at_once);
    file_->finish_addition();
}

} // namespace carrom
