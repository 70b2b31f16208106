// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <vector>

#include <fcntl.h>

#include "core/state_hash.hpp"
#include "io/checked_dataset.hpp"
#include "io/checkpoint.hpp"
#include "io/checkpoint_fields.hpp"
#include "io/crash_guard.hpp"
#include "io/files.hpp"
#include "io/seal.hpp"
#include "parallel/slabs.hpp"

namespace carrom {

namespace {

/// What no writer of this program would write; a sealed file that has it was made by something
/// else.
void check_header(const CheckpointHeader& header) {
    if (header.micro_steps < 1 || header.sync_every < 1 || header.step < 0 || header.n_discs == 0 ||
        header.micro_steps_done / header.micro_steps != header.step ||
        header.micro_steps_done % header.micro_steps != 0)
        throw FileError("its numbers contradict each other");
}

CheckpointHeader header_of(const std::string& path, const Communicator& communicator) {
    CheckpointHeader header;
    on_root(communicator, path, ExitCode::bad_input, [&] {
        const CrashGuard guard(path);
        const h5::File file = h5::open_file(path, h5::Access::read);
        const h5::Group run(
            h5::checked(H5Gopen2(file.id(), "/carrom/run", H5P_DEFAULT), "has no /carrom/run"));
        header = read_header(run.id());
        header.has_spins = has_spins(file.id());
        check_header(header);
        // A file that claims more discs than it has room for must not cost their memory.
        if (header.n_discs > Descriptor(path, O_RDONLY).size() / (8 * disc_columns.size()))
            throw FileError("has not got as many discs as it says");
        header.species = read_species(file.id(), header.n_discs);
    });
    broadcast(header, communicator);
    return header;
}

/// This rank's share of all columns. A rank that cannot read leaves no other waiting.
void read_columns(hid_t file, const std::string& path, std::uint64_t n, std::vector<Disc>& slab,
                  const Communicator& communicator) {
    std::vector<h5::Dataset> datasets;
    on_all(communicator, path, ExitCode::bad_input, [&] {
        for (const DiscColumn& column : disc_columns) {
            datasets.push_back(
                h5::open_checked(file, std::string("/carrom/discs/") + column.name, {n}));
        }
    });
    const std::uint64_t first = slab_begin(communicator.rank(), n, communicator.size());
    on_all(communicator, path, ExitCode::bad_input, [&] {
        std::vector<std::uint64_t> numbers(rows_per_piece);
        for (std::uint64_t begin = 0; begin < slab.size(); begin += rows_per_piece) {
            const std::uint64_t end = std::min<std::uint64_t>(begin + rows_per_piece, slab.size());
            for (std::size_t k = 0; k < datasets.size(); ++k) {
                h5::read_rows(datasets[k].id(), {first + begin, first + end},
                              type_of(disc_columns[k]), numbers.data());
                for (std::uint64_t row = begin; row < end; ++row)
                    disc_columns[k].set(slab[row], numbers[row - begin]);
            }
        }
    });
}

/// This rank's share of the spins; empty where discs do not turn. **Collective.**
std::vector<double> read_spins(hid_t file, const std::string& path, const CheckpointHeader& header,
                               const Communicator& communicator) {
    if (!header.has_spins) return {};
    const std::uint64_t first = slab_begin(communicator.rank(), header.n_discs,
                                           communicator.size());
    std::vector<double> spins(
        slab_begin(communicator.rank() + 1, header.n_discs, communicator.size()) - first);
    on_all(communicator, path, ExitCode::bad_input, [&] {
        const h5::Dataset column = h5::open_checked(file, spin_column, {header.n_discs});
        if (!spins.empty())
            h5::read_rows(column.id(), {first, first + spins.size()}, H5T_NATIVE_DOUBLE,
                          spins.data());
    });
    return spins;
}

/// What the file has of measurements; most have nothing.
StoredSamples read_samples(hid_t file, const std::string& path, std::uint64_t n,
                           const Communicator& communicator) {
    constexpr const char* sums_name = "/carrom/measurements/sums";
    StoredSamples samples;
    const std::uint64_t first = slab_begin(communicator.rank(), n, communicator.size());
    const std::uint64_t end = slab_begin(communicator.rank() + 1, n, communicator.size());
    on_all(communicator, path, ExitCode::bad_input, [&] {
        if (H5Lexists(file, "/carrom/measurements", H5P_DEFAULT) <= 0) return;
        const h5::Dataset sums = h5::open_checked(file, sums_name, {std::nullopt});
        const hsize_t size = h5::dimensions_of(sums.id()).front();
        if (size == 0) throw FileError("its measurements are no list of sums");
        samples.sums.resize(size);
        h5::read_rows(sums.id(), {0, size}, H5T_NATIVE_INT64, samples.sums.data());
        samples.have_first_places = H5Lexists(file, "/carrom/measurements/first_x", H5P_DEFAULT) >
                                    0;
        samples.have_lengths = H5Lexists(file, "/carrom/measurements/lengths_x", H5P_DEFAULT) > 0;
        if (!samples.have_first_places) return;
        samples.first_places.resize(end - first);
        std::vector<double> numbers(end - first);
        for (const SampleColumn& column : sample_columns) {
            if (!column.is_in(samples)) continue;
            const h5::Dataset places = h5::open_checked(
                file, std::string("/carrom/measurements/") + column.name, {n});
            if (numbers.empty()) continue;
            h5::read_rows(places.id(), {first, end}, H5T_NATIVE_DOUBLE, numbers.data());
            for (std::size_t i = 0; i < numbers.size(); ++i)
                samples.first_places[i].*column.field = numbers[i];
        }
        for (std::size_t i = 0; i < samples.first_places.size(); ++i)
            samples.first_places[i].id = first + i;
    });
    return samples;
}

} // namespace

CheckpointHeader read_checkpoint_header(const std::string& path, const Communicator& communicator) {
    check_seal(path, communicator); // HDF5 does not promise to survive every damaged file
    return header_of(path, communicator);
}

void check_damage(const std::string& path, const Communicator& communicator) {
    std::uint64_t is_checkpoint = 0;
    on_root(communicator, path, ExitCode::bad_input,
            [&] { is_checkpoint = is_sealed(path) ? 1 : 0; });
    communicator.broadcast(is_checkpoint);
    if (is_checkpoint == 1) check_seal(path, communicator);
}

Checkpoint read_checkpoint(const std::string& path, const Communicator& communicator) {
    check_seal(path, communicator);
    Checkpoint checkpoint;
    checkpoint.header = header_of(path, communicator);
    const std::uint64_t n = checkpoint.header.n_discs;
    const std::uint64_t first = slab_begin(communicator.rank(), n, communicator.size());
    checkpoint.discs.resize(slab_begin(communicator.rank() + 1, n, communicator.size()) - first);
    for (std::size_t i = 0; i < checkpoint.discs.size(); ++i) checkpoint.discs[i].id = first + i;
    const CrashGuard guard(path);
    h5::File file;
    on_all(communicator, path, ExitCode::bad_input,
           [&] { file = h5::open_file(path, h5::Access::read, communicator); });
    read_columns(file.id(), path, n, checkpoint.discs, communicator);
    checkpoint.spins = read_spins(file.id(), path, checkpoint.header, communicator);
    checkpoint.samples = read_samples(file.id(), path, n, communicator);
    StateHash mine = hash_of(checkpoint.discs);
    for (std::size_t i = 0; i < checkpoint.spins.size(); ++i)
        mine += hash_of_spin(checkpoint.discs[i].id, checkpoint.spins[i]);
    std::uint64_t sums[] = {mine.low, mine.high};
    communicator.sum(sums);
    on_root(communicator, path, ExitCode::bad_input, [&] {
        if (to_string(StateHash{sums[0], sums[1]}) != checkpoint.header.state_hash)
            throw FileError("its discs do not have its state hash");
    });
    return checkpoint;
}

} // namespace carrom
