// SPDX-License-Identifier: BSD-3-Clause
#include "io/collision_log.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>
#include <variant>
#include <vector>

#include "io/h5md.hpp"
#include "io/segmented_file.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace {

constexpr std::size_t rows_at_once = 1 << 18;

struct Column {
    const char* path;
    std::variant<double LoggedCollision::*, std::int64_t LoggedCollision::*> field;
};

constexpr std::array<Column, 5> log_columns = {
    {{"/carrom/collisions/step", &LoggedCollision::step},
     {"/carrom/collisions/time", &LoggedCollision::time},
     {"/carrom/collisions/p", &LoggedCollision::p},
     {"/carrom/collisions/q", &LoggedCollision::q},
     {"/carrom/collisions/impulse", &LoggedCollision::impulse}}};

std::vector<RecordedColumn> recorded_columns(const RecordedSystem& system) {
    std::vector<RecordedColumn> recorded;
    for (const Column& column : log_columns)
        recorded.push_back(
            {column.path, column.field.index() == 0 ? H5T_IEEE_F64LE : H5T_STD_I64LE, {}});
    recorded[1].unit = h5md::unit_of(system, 0, 1); // of times
    return recorded;
}

void write_structure(hid_t file, const RecordedSystem& system) {
    h5md::write_system(file, system);
    h5md::write_bodies(file, system);
    const std::array<double, 3> edges = h5md::edges_of(system);
    h5::write_whole(file, "/particles/discs/box/edges", std::array<hsize_t, 1>{3},
                    H5T_NATIVE_DOUBLE, edges.data());
    static_cast<void>(h5::create_group(file, "/carrom/collisions"));
}

void write_rows(SegmentedFile& file, std::span<const LoggedCollision> rows) {
    while (!rows.empty()) {
        const auto some = rows.first(std::min<std::uint64_t>(rows.size(), file.room()));
        std::vector<std::uint64_t> numbers(some.size());
        for (std::size_t k = 0; k < log_columns.size(); ++k) {
            for (std::size_t i = 0; i < some.size(); ++i)
                numbers[i] = std::visit(
                    [&](auto field) { return std::bit_cast<std::uint64_t>(some[i].*field); },
                    log_columns[k].field);
            file.write(k, std::as_bytes(std::span(numbers)));
        }
        file.add(some.size());
        rows = rows.subspan(some.size());
    }
}

} // namespace

struct CollisionLog::State {
    SegmentedFile file;
};

CollisionLog::CollisionLog(const std::string& path, const RecordedSystem& system,
                           const Communicator& communicator)
    : communicator_(communicator) {
    state_ = std::make_unique<State>(
        State{{path, recorded_columns(system),
               [system](hid_t index) { write_structure(index, system); }, communicator}});
}

CollisionLog::~CollisionLog() = default;

void CollisionLog::begin() { state_->file.begin(); }

bool CollisionLog::go_on(std::int64_t step) {
    return state_->file.go_on(log_columns.front().path, step, [&](hid_t file) {
        if (!h5::has(file, "/carrom/collisions")) throw FileError("is no log of collisions");
    });
}

void CollisionLog::commit() { state_->file.commit(); }

void CollisionLog::append(std::span<const LoggedCollision> mine) {
    if (communicator_.sum(std::uint64_t{mine.size()}) == 0) return;
    const auto write = [&](std::span<const LoggedCollision> rows) {
        state_->file.attempt([&] { write_rows(state_->file, rows); });
    };
    stream_to_root(communicator_, mine, write, rows_at_once);
    state_->file.finish_addition();
}

} // namespace carrom
