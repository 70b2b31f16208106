// SPDX-License-Identifier: BSD-3-Clause
#include "sample_files.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>

#include "core/errors.hpp"
#include "io/checkpoint.hpp"
#include "io/checksums.hpp"
#include "io/collision_log.hpp"

/// HDF5's hash of its metadata, which its public headers do not contain.
extern "C" std::uint32_t H5_checksum_metadata(const void* bytes, std::size_t length,
                                              std::uint32_t start);

namespace carrom::test {

namespace {

/// Twelve discs in a box of size 10.
std::vector<DiscState> some_discs() {
    std::vector<DiscState> discs(12);
    for (std::size_t i = 0; i < discs.size(); ++i) {
        discs[i].id = i;
        discs[i].x = 1 + 0.5 * static_cast<double>(i);
        discs[i].y = 5;
        discs[i].vx = 0.125;
        discs[i].tau = static_cast<double>(i % 6);
        discs[i].pair_collisions = (i / 2) & 0xff;
    }
    return discs;
}

std::vector<double> some_spins() {
    std::vector<double> spins(some_discs().size(), 0.25);
    spins[3] = -2;
    return spins;
}

SideSpans spans_of(const std::vector<double>& spins) {
    SideSpans spans;
    spans[SideColumn::spin] = spins;
    return spans;
}

} // namespace

std::vector<char> bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::string& path, const std::vector<char>& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void write_sample_checkpoint(const std::string& path, const Communicator& world) {
    CheckpointHeader header;
    header.program_version = "0.1.0";
    header.scene_name = "fuzz.toml";
    header.scene_text =
        "[box]\nsize = 10\n[discs]\ncount = 12\nradius = 0.5\n[time]\nsteps = 100\n"
        "[effects.contact]\nkind = \"rough\"\nrestitution = 0.9\ntangential_restitution = 0.5\n";
    header.set_box(10);
    header.radius = 0.5;
    header.method = "time-stepped";
    header.sync_every = 64;
    header.step = header.micro_steps_done = 70;
    header.species = {{5, 0.5, 1}, {7, 0.25, 2}};
    header.columns.add(SideColumn::spin);
    const std::vector<double> spins = some_spins();
    write_checkpoint(path, header, some_discs(), world, {}, {}, spans_of(spins));
}

TrajectoryLayout sample_layout(bool is_double) {
    TrajectoryLayout layout;
    layout.system.program_version = "0.1.0";
    layout.system.n_discs = some_discs().size();
    layout.system.box = 10;
    layout.system.radius = 0.5;
    layout.has_collisions = true;
    layout.is_single = !is_double;
    if (is_double) layout.columns.add(SideColumn::spin);
    return layout;
}

void write_sample_trajectory(const std::string& path, bool is_double, const Communicator& world) {
    const std::vector<DiscState> discs = some_discs();
    Trajectory trajectory(path, sample_layout(is_double), world);
    trajectory.begin();
    const std::vector<double> spins = some_spins();
    for (const std::int64_t step : {0, 10, 20}) trajectory.append(step, discs, 6, spans_of(spins));
    trajectory.commit();
}

void write_sample_log(const std::string& path, const Communicator& world) {
    std::vector<LoggedCollision> rows;
    for (std::int64_t i = 0; i < 20; ++i)
        rows.push_back(
            {1 + i / 4, 0.25 * static_cast<double>(i), i % 6, i % 3 == 0 ? -1 : 6 + i % 6, 0.5});
    CollisionLog log(path, sample_layout(false).system, world);
    log.begin();
    log.append(rows, 5);
    log.commit();
}

Forger::Forger(const std::string& whole)
    : sums_(read_checksums(h5::open_file(whole, h5::Access::read).id())) {
    const std::vector<char> bytes = bytes_of(whole);
    constexpr std::array signatures = {"\x89HDF", "OHDR", "OCHK"};
    constexpr std::size_t longest = 4096;
    for (std::size_t begin = 0; begin + 8 < bytes.size(); ++begin) {
        const bool is_metadata = std::any_of(
            signatures.begin(), signatures.end(),
            [&](const char* signature) { return std::memcmp(&bytes[begin], signature, 4) == 0; });
        for (std::size_t end = begin + 8;
             is_metadata && end + 4 <= std::min(bytes.size(), begin + longest); ++end) {
            const std::uint32_t sum = H5_checksum_metadata(&bytes[begin], end - begin, 0);
            if (std::memcmp(&sum, &bytes[end], sizeof sum) != 0) continue;
            metadata_.push_back({begin, end});
            break;
        }
    }
    ensure(metadata_.size() > 20, "a sample's metadata are not found");
}

void Forger::write(const std::string& path, std::vector<char> bytes) const {
    for (const ByteRange& block : metadata_) {
        const std::uint32_t sum = H5_checksum_metadata(&bytes[block.begin], block.end - block.begin,
                                                       0);
        std::memcpy(&bytes[block.end], &sum, sizeof sum);
    }
    Checksums sums = sums_;
    for (DiscData& one : sums.data) {
        ensure(one.rows <= rows_per_block, "a sample is larger than a block");
        one.checksum = checksum_of_block(
            std::as_bytes(std::span(bytes))
                .subspan(one.place.begin, one.place.end - one.place.begin),
            0);
    }
    write_bytes(path, bytes);
    sums.others = checksum_of_others(path, sums.left_out());
    const std::string text = sums.text();
    std::copy(text.begin(), text.end(),
              bytes.begin() + static_cast<std::ptrdiff_t>(sums.place.begin));
    write_bytes(path, bytes);
}

} // namespace carrom::test
