// SPDX-License-Identifier: BSD-3-Clause
#include "io/checkpoint_structure.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fcntl.h>

#include "io/checked_dataset.hpp"
#include "io/checkpoint_fields.hpp"
#include "io/files.hpp"
#include "io/h5md.hpp"

namespace carrom {

namespace {

constexpr const char *radius_path = "/particles/discs/radius",
                     *species_number_path = "/particles/discs/species";

/// The ids before which species end.
std::vector<DiscId> ends_of(const std::vector<Species>& species) {
    std::vector<DiscId> ends;
    for (const Species& one : species) ends.push_back((ends.empty() ? 0 : ends.back()) + one.count);
    return ends;
}

/// What `number_of` makes of each disc, one after the other.
template <class NumberOf>
void put_each(std::span<const Disc> discs, std::byte* out, const NumberOf& number_of) {
    for (const Disc& disc : discs) {
        const auto number = number_of(disc);
        std::memcpy(out, &number, sizeof number);
        out += sizeof number;
    }
}

void create_column(hid_t parent, const char* name, std::span<const hsize_t> dimensions, hid_t type,
                   const std::string& unit = "") {
    const h5::Properties creation = h5::allocated_creation();
    const h5::Dataset dataset(h5::checked(H5Dcreate2(parent, name, type, h5::space(dimensions).id(),
                                                     H5P_DEFAULT, creation.id(), H5P_DEFAULT),
                                          name));
    h5md::write_unit(dataset.id(), unit);
}

void write_unit(hid_t parent, const char* name, const std::string& unit) {
    h5md::write_unit(h5::open_checked(parent, name).id(), unit);
}

/// A group of one frame: its step and time here, its `value` is the caller's.
h5::Group create_frame(hid_t parent, const char* name, const CheckpointHeader& header) {
    h5::Group group = h5::create_group(parent, name);
    const std::array<hsize_t, 1> one = {1};
    const auto time = static_cast<double>(header.step);
    h5::write_whole(group.id(), "step", one, H5T_NATIVE_INT64, &header.step);
    h5::write_whole(group.id(), "time", one, H5T_NATIVE_DOUBLE, &time);
    write_unit(group.id(), "time", h5md::unit_of(header.shown, 0, 1));
    return group;
}

void create_groups(hid_t file, const CheckpointHeader& header, const StoredSamples& samples) {
    h5md::write_system(file, header.shown);
    const std::array<hsize_t, 1> rows = {header.n_discs};
    const std::array<hsize_t, 3> vectors = {1, header.n_discs, 3};
    const std::array<double, 3> edges = h5md::edges_of(header.shown);
    h5::write_whole(create_frame(file, "/particles/discs/box/edges", header).id(), "value",
                    std::array<hsize_t, 2>{1, 3}, H5T_NATIVE_DOUBLE, edges.data());
    const std::string length = h5md::unit_of(header.shown, 1, 0);
    write_unit(file, h5md::edges_path, length);
    for (const auto& [name, unit] :
         {std::pair("/particles/discs/position", length),
          std::pair("/particles/discs/velocity", h5md::unit_of(header.shown, 1, -1))})
        create_column(create_frame(file, name, header).id(), "value", vectors, H5T_NATIVE_FLOAT,
                      unit);
    if (header.shown.species.empty()) {
        h5md::write_bodies(file, header.shown);
    } else {
        create_column(file, radius_path, rows, H5T_NATIVE_DOUBLE, length);
        create_column(file, species_number_path, rows, H5T_NATIVE_INT32);
    }

    const h5::Group carrom = h5::create_group(file, "carrom");
    h5::write_scalar(file, format_path, checkpoint_format);
    write_header(h5::create_group(carrom.id(), "run").id(), header);
    write_species(file, species_path, header.species);
    const h5::Group columns = h5::create_group(carrom.id(), "discs");
    for (const StateColumn& column : disc_columns)
        create_column(columns.id(), column.name, rows, type_of(column));
    header.columns.for_each([&](SideColumn column) {
        create_column(file, path_of(column).c_str(), rows, H5T_NATIVE_DOUBLE);
    });
    const auto write_numbers = [](hid_t parent, const char* name,
                                  const std::vector<std::int64_t>& numbers) {
        h5::write_whole(parent, name, std::array<hsize_t, 1>{numbers.size()}, H5T_NATIVE_INT64,
                        numbers.data());
    };
    if (!samples.averages.empty()) write_numbers(carrom.id(), "averages", samples.averages);
    if (!samples.sums.empty()) {
        const h5::Group measurements = h5::create_group(carrom.id(), "measurements");
        write_numbers(measurements.id(), "sums", samples.sums);
    }
    if (samples.have_images) static_cast<void>(h5::create_group(carrom.id(), "trajectory"));
    for (const SampleColumn& column : sample_columns)
        if (column.is_in(samples)) create_column(file, column.path, rows, H5T_NATIVE_DOUBLE);
}

} // namespace

std::vector<DiscTarget> disc_targets(const CheckpointHeader& header, const StoredSamples& samples,
                                     const SideOfPieces& columns) {
    std::vector<DiscTarget> targets;
    const Frame frame = header.frame;
    const double clock = header.clock(), k = static_cast<double>(header.micro_steps);
    const auto vector_of = [](double x, double y) {
        return std::array<float, 3>{static_cast<float>(x), static_cast<float>(y), 0};
    };
    const auto add = [&](std::string path, hid_t type, std::uint64_t n_numbers,
                         std::function<void(std::span<const Disc>, std::byte*)> put) {
        targets.push_back({std::move(path), type, n_numbers * H5Tget_size(type), std::move(put)});
    };
    add("/particles/discs/position/value", H5T_NATIVE_FLOAT, 3,
        [=](std::span<const Disc> discs, std::byte* out) {
            put_each(discs, out, [=](const Disc& disc) {
                const Disc shown = frame.in_box(disc, clock);
                return vector_of(shown.x, shown.y);
            });
        });
    add("/particles/discs/velocity/value", H5T_NATIVE_FLOAT, 3,
        [=](std::span<const Disc> discs, std::byte* out) {
            put_each(discs, out, [=](const Disc& disc) {
                const Disc shown = frame.in_box(disc, clock);
                return vector_of(shown.vx * k, shown.vy * k);
            });
        });
    if (!header.shown.species.empty()) {
        add(radius_path, H5T_NATIVE_DOUBLE, 1,
            [table = SpeciesTable(header.shown.species, header.radius)](std::span<const Disc> discs,
                                                                        std::byte* out) {
                put_each(discs, out, [&](const Disc& disc) { return table.of(disc.id).radius; });
            });
        add(species_number_path, H5T_NATIVE_INT32, 1,
            [ends = ends_of(header.shown.species)](std::span<const Disc> discs, std::byte* out) {
                put_each(discs, out, [&](const Disc& disc) {
                    return static_cast<std::int32_t>(
                        std::upper_bound(ends.begin(), ends.end(), disc.id) - ends.begin());
                });
            });
    }
    for (const StateColumn& column : disc_columns)
        add(path_of(column), type_of(column), 1, column.put);
    header.columns.for_each([&](SideColumn column) {
        add(path_of(column), H5T_NATIVE_DOUBLE, 1,
            [column, &columns](std::span<const Disc> discs, std::byte* out) {
                put_each(discs, out, [&](const Disc& disc) { return columns.of(column, disc); });
            });
    });
    for (const SampleColumn& column : sample_columns) {
        if (!column.is_in(samples)) continue;
        add(column.path, H5T_NATIVE_DOUBLE, 1,
            [&column, &places = samples.first_places](std::span<const Disc> discs, std::byte* out) {
                put_each(discs, out, [&](const Disc& disc) {
                    return places[disc.id - places.front().id].*column.field;
                });
            });
    }
    return targets;
}

void create_structure(const std::string& path, CheckpointHeader header,
                      const StoredSamples& samples, const std::vector<DiscTarget>& targets) {
    header.wall_collisions = header.pair_collisions = 0;
    header.state_hash = to_string(StateHash{});
    Checksums sums;
    for (const DiscTarget& target : targets) sums.data.push_back({target.path, 0, 0, {}, {}});
    header.shown.n_discs = header.n_discs;
    header.shown.program_version = header.program_version;
    h5::create_file(path, [&](hid_t file) {
        create_groups(file, header, samples);
        h5::write_text(file, checksums_path, sums.text());
    });
}

void complete(const std::string& path, const StateSums& sums,
              const std::vector<StateHash>& checksums) {
    h5::File file = h5::open_file(path, h5::Access::write);
    const auto overwrite_count = [&](const char* name, std::uint64_t count) {
        h5::overwrite(file.id(), name, H5T_NATIVE_UINT64, &count);
    };
    overwrite_count("/carrom/run/wall_collisions", sums.wall_collisions);
    overwrite_count("/carrom/run/pair_collisions", sums.pair_collisions / 2);
    h5::overwrite_text(file.id(), "/carrom/run/state_hash", to_string(sums.hash));
    Checksums all = read_checksums(file.id());
    file.close("cannot be written");
    for (std::size_t k = 0; k < checksums.size(); ++k) all.data[k].checksum = checksums[k];
    all.others = checksum_of_others(path, all.left_out()); // a file open to be written says so
    file = h5::open_file(path, h5::Access::write);
    h5::overwrite_text(file.id(), checksums_path, all.text());
    file.close("cannot be written");
    Descriptor(path, O_RDWR).sync();
}

} // namespace carrom
