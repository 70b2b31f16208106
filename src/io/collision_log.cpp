// SPDX-License-Identifier: BSD-3-Clause
#include "io/collision_log.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "io/h5md.hpp"
#include "io/segmented_file.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace {

constexpr std::size_t rows_at_once = 1 << 18;

/// The words of a LoggedCollision, one after the other.
constexpr std::array column_names = {"step", "time", "p", "q", "impulse"};
using Words = std::array<std::uint64_t, column_names.size()>;
constexpr std::size_t time_column = 1, impulse_column = 4; // of real numbers

std::vector<RecordedColumn> recorded_columns(const RecordedSystem& system) {
    std::vector<RecordedColumn> recorded;
    for (const char* name : column_names)
        recorded.push_back({std::string(h5md::collisions_path) + name, H5T_STD_I64LE, {}});
    recorded[time_column].type = recorded[impulse_column].type = H5T_IEEE_F64LE;
    recorded[time_column].unit = h5md::unit_of(system, 0, 1);
    return recorded;
}

void write_structure(hid_t file, const RecordedSystem& system) {
    h5md::write_system(file, system);
    h5md::write_bodies(file, system);
    h5::write_column(file, "/particles/discs/box/edges", h5md::edges_of(system));
    static_cast<void>(h5::create_group(file, "/carrom/collisions"));
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
          path, recorded_columns(system), [system](hid_t index) { write_structure(index, system); },
          communicator)),
      communicator_(communicator) {}

CollisionLog::~CollisionLog() = default;

void CollisionLog::begin() { file_->begin(); }

bool CollisionLog::go_on(std::int64_t step) {
    return file_->go_on(std::string(h5md::collisions_path) + column_names[0], step,
                        [&](hid_t file) {
                            if (!h5::has(file, "/carrom/collisions"))
                                throw FileError("is no log of collisions");
                        });
}

void CollisionLog::commit() { file_->commit(); }

void CollisionLog::append(std::span<const LoggedCollision> mine) {
    if (communicator_.sum(std::uint64_t{mine.size()}) == 0) return;
    const auto write = [&](std::span<const LoggedCollision> rows) {
        file_->attempt([&] { write_rows(*file_, rows); });
    };
    stream_to_root(communicator_, mine, write, rows_at_once);
    file_->finish_addition();
}

} // namespace carrom
