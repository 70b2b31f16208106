// SPDX-License-Identifier: BSD-3-Clause
#include "io/collision_log.hpp"

#include <array>
#include <bit>
#include <utility>
#include <variant>
#include <vector>

#include "io/appended_file.hpp"
#include "io/checked_dataset.hpp"
#include "io/crash_guard.hpp"
#include "io/files.hpp"
#include "io/h5md.hpp"
#include "io/recorded_run.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace {

constexpr hsize_t rows_per_chunk = 1 << 14;
constexpr std::size_t rows_per_piece = 1 << 18;

struct Column {
    const char* path;
    std::variant<double LoggedCollision::*, std::int64_t LoggedCollision::*> field;
};

constexpr std::array<Column, 5> columns = {
    {{"/carrom/collisions/step", &LoggedCollision::step},
     {"/carrom/collisions/time", &LoggedCollision::time},
     {"/carrom/collisions/p", &LoggedCollision::p},
     {"/carrom/collisions/q", &LoggedCollision::q},
     {"/carrom/collisions/impulse", &LoggedCollision::impulse}}};

hid_t type_of(const Column& column) {
    return column.field.index() == 0 ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
}

void create_structure(hid_t file, const std::string& program_version) {
    h5md::write_metadata(file, program_version);
    const h5::Group carrom = h5::create_group(file, "carrom"),
                    log = h5::create_group(carrom.id(), "collisions");
    for (const Column& column : columns)
        create_growing(file, column.path, type_of(column), {},
                       std::array<hsize_t, 1>{rows_per_chunk}, 0);
}

void check_columns(hid_t file) {
    const hsize_t n_rows = length_of(file, columns.front().path);
    for (const Column& column : columns)
        static_cast<void>(h5::open_checked(file, column.path, {n_rows}));
}

void write_rows(hid_t file, hsize_t begin, std::span<const LoggedCollision> rows) {
    std::vector<std::uint64_t> numbers(rows.size());
    const std::array<hsize_t, 1> start = {begin}, count = {rows.size()};
    for (const Column& column : columns) {
        for (std::size_t i = 0; i < rows.size(); ++i)
            numbers[i] = std::visit(
                [&](auto field) { return std::bit_cast<std::uint64_t>(rows[i].*field); },
                column.field);
        set_length(file, column.path, begin + rows.size());
        write_block(file, column.path, start, count, type_of(column), numbers.data());
    }
}

} // namespace

struct CollisionLog::State {
    explicit State(const std::string& path) : file(path) {}
    AppendedFile file;
    hsize_t n_rows = 0;
};

CollisionLog::CollisionLog(const std::string& path, const std::string& program_version,
                           const Communicator& communicator, CheckpointHeader run)
    : path_(path), program_version_(program_version), run_(std::move(run)),
      communicator_(communicator) {
    if (communicator_.is_root()) state_ = std::make_unique<State>(path);
}

CollisionLog::~CollisionLog() = default;

void CollisionLog::begin() {
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        check_room(folder_of(path_), 1 << 20);
        state_->file.create([&](hid_t file) {
            create_structure(file, program_version_);
            write_recorded_run(file, run_);
        });
        state_->n_rows = 0;
    });
}

bool CollisionLog::go_on(std::int64_t step, const DifferenceFrom& difference_from) {
    std::uint64_t is_there = 0;
    on_root(communicator_, path_, ExitCode::output_failure,
            [&] { is_there = state_->file.reopen() ? 1 : 0; });
    communicator_.broadcast(is_there);
    if (is_there == 0) {
        begin();
        return false;
    }
    on_root(communicator_, path_, ExitCode::bad_input, [&] {
        const CrashGuard guard(path_);
        {
            const h5::File file = h5::open_file(path_, h5::Access::read);
            if (!h5::has(file.id(), "/carrom/collisions"))
                throw FileError("is no log of collisions");
            check_recorded_run(file.id(), difference_from);
            check_columns(file.id());
        }
        state_->file.change([&](hid_t file) {
            state_->n_rows = count_up_to(file, columns.front().path, step);
            for (const Column& column : columns) set_length(file, column.path, state_->n_rows);
        });
    });
    return true;
}

void CollisionLog::commit() {
    on_root(communicator_, path_, ExitCode::output_failure, [&] { state_->file.commit(); });
}

void CollisionLog::append(std::span<const LoggedCollision> mine) {
    if (communicator_.sum(std::uint64_t{mine.size()}) == 0) return;
    on_root(communicator_, path_, ExitCode::output_failure, [&] { state_->file.open(); });
    const auto write = [&](std::span<const LoggedCollision> rows) {
        state_->file.attempt([&](hid_t file) { write_rows(file, state_->n_rows, rows); });
        state_->n_rows += rows.size();
    };
    stream_to_root(communicator_, mine, write, rows_per_piece);
    on_root(communicator_, path_, ExitCode::output_failure, [&] { state_->file.close(); });
}

} // namespace carrom
