// SPDX-License-Identifier: BSD-3-Clause
// The cost of HDF5 and MPI-IO: checkpoints as the program writes them, compared with the same file
// whose numbers are written by plain positioned writes. Both pack the same discs, compute the same
// checksums and bring all bytes to disk. They take turns, so that other users of the disk slow both
// down equally.
//   mpirun -np 2 build/tests/checkpoint_speed FOLDER [DISCS [ROUNDS [THREADS]]]
// Prints seconds of each round, and the median of the ratios. Needs 80 bytes a disc on disk, and 64
// in memory.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "io/checkpoint.hpp"
#include "io/checkpoint_structure.hpp"
#include "io/checksums.hpp"
#include "io/files.hpp"
#include "io/start_io.hpp"
#include "parallel/mpi.hpp"
#include "parallel/pieces.hpp"
#include "parallel/slabs.hpp"

using namespace carrom;

namespace {

using Clock = std::chrono::steady_clock;
using Buffers = std::vector<std::vector<std::byte>>;

constexpr std::uint64_t pieces_between_syncs = 8;

void pack(std::span<const DiscState> piece, std::uint64_t first,
          const std::vector<DiscTarget>& targets, Buffers& buffers, StateSums& sums,
          int n_threads) {
    for (std::size_t k = 0; k < targets.size(); ++k)
        buffers[k].resize(piece.size() * targets[k].bytes_per_row);
    const std::size_t n_blocks = (piece.size() + rows_per_block - 1) / rows_per_block;
#pragma omp parallel num_threads(n_threads)
    {
        StateSums mine(sums.size());
#pragma omp for schedule(static)
        for (std::size_t block = 0; block < n_blocks; ++block) {
            const std::size_t row = block * rows_per_block;
            const auto discs = piece.subspan(
                row, std::min<std::size_t>(rows_per_block, piece.size() - row));
            for (const DiscState& disc : discs)
                mine[place_of_collisions] += {disc.wall_collisions, disc.pair_collisions};
            mine[place_of_hash] += hash_of(discs);
            for (std::size_t k = 0; k < targets.size(); ++k) {
                const std::size_t width = targets[k].bytes_per_row;
                const auto bytes = std::span(buffers[k]).subspan(row * width, discs.size() * width);
                targets[k].put(discs, bytes.data());
                mine[first_checksum + k] += checksum_of_block(bytes,
                                                              first / rows_per_block + block);
            }
        }
#pragma omp critical(sums_of_a_piece)
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += mine[k];
    }
}

std::vector<std::uint64_t> places_of(const std::string& path,
                                     const std::vector<DiscTarget>& targets) {
    const h5::File file = h5::open_file(path, h5::Access::read);
    std::vector<std::uint64_t> places;
    for (const DiscTarget& target : targets)
        places.push_back(H5Dget_offset(h5::open_dataset(file.id(), target.path).id()));
    return places;
}

/// Packs a piece while the one before is written. **Collective.**
StateSums write_numbers(const std::string& path, const std::vector<DiscTarget>& targets,
                        std::span<const DiscState> discs, std::uint64_t n_discs, int n_threads,
                        const Communicator& communicator) {
    std::vector<std::uint64_t> places(targets.size());
    if (communicator.is_root()) places = places_of(path, targets);
    for (std::uint64_t& place : places) communicator.broadcast(place);
    const Descriptor file(path, O_WRONLY);
    PieceStream stream(communicator, discs, n_discs, [](const DiscState& disc) { return disc.id; });
    StateSums sums(first_checksum + targets.size());
    std::array<Buffers, 2> buffers;
    buffers.fill(Buffers(targets.size()));
    std::future<void> under_way;
    for (std::uint64_t round = 0; round < stream.pieces().n_rounds(); ++round) {
        const std::span<const DiscState> piece = stream.next();
        if (piece.empty()) continue;
        Buffers& next = buffers[round % 2];
        pack(piece, stream.begin(), targets, next, sums, n_threads);
        if (under_way.valid()) under_way.get();
        under_way = std::async(std::launch::async, [&, first = stream.begin(), round] {
            for (std::size_t k = 0; k < targets.size(); ++k)
                file.write(next[k], places[k] + first * targets[k].bytes_per_row);
            if ((round + 1) % pieces_between_syncs == 0) file.start_sync();
        });
    }
    if (under_way.valid()) under_way.get();
    file.sync();
    sum_over(communicator, sums);
    return sums;
}

/// Writes the same bytes as `write_checkpoint`. **Collective.**
void write_plainly(const std::string& path, CheckpointHeader header,
                   std::span<const DiscState> discs, int n_threads,
                   const Communicator& communicator) {
    header.n_discs = communicator.sum(std::uint64_t{discs.size()});
    const StoredSamples samples;
    const SideOfPieces columns;
    const std::vector<DiscTarget> targets = disc_targets(header, samples, columns);
    const std::string partial = path + ".partial";
    on_root(communicator, path, ExitCode::output_failure, [&] {
        create_structure(partial, header, samples, targets);
        reserve(partial);
    });
    const StateSums sums = write_numbers(partial, targets, discs, header.n_discs, n_threads,
                                         communicator);
    on_root(communicator, path, ExitCode::output_failure, [&] {
        complete(partial, sums);
        rename_durably(partial, path);
    });
}

/// Discs in the order of ids, so that sorting takes no time.
std::vector<DiscState> own_discs(std::uint64_t n_discs, const Communicator& communicator) {
    const std::uint64_t begin = slab_begin(communicator.rank(), n_discs, communicator.size());
    std::vector<DiscState> discs(slab_begin(communicator.rank() + 1, n_discs, communicator.size()) -
                                 begin);
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const auto id = static_cast<double>(begin + i);
        discs[i].id = begin + i;
        discs[i].x = id / 3;
        discs[i].y = id / 7;
        discs[i].vx = 1 / (id + 3);
        discs[i].vy = 1 / (id + 7);
        discs[i].wall_collisions = (begin + i) & 0xffff;
    }
    return discs;
}

template <class Write>
double seconds_of(const Write& write, const std::string& path, const Communicator& communicator) {
    communicator.barrier();
    const auto start = Clock::now();
    write();
    communicator.barrier();
    const std::chrono::duration<double> seconds = Clock::now() - start;
    if (communicator.is_root()) {
        ::unlink(path.c_str());
        ::sync(); // the next measurement need not wait for these writes
    }
    return seconds.count();
}

double median(std::vector<double> numbers) {
    std::sort(numbers.begin(), numbers.end());
    return numbers[numbers.size() / 2];
}

int compare(const std::string& folder, std::uint64_t n_discs, int rounds, int n_threads,
            const Communicator& communicator) {
    const std::vector<DiscState> discs = own_discs(n_discs, communicator);
    CheckpointHeader header;
    header.set_box(1);
    header.radius = 1;
    const std::string path = folder + "/checkpoint_speed.h5";
    std::vector<double> ratios;
    for (int round = 0; round < rounds; ++round) {
        double ours = 0, plain = 0;
        for (const bool is_ours : {round % 2 == 0, round % 2 != 0})
            (is_ours ? ours : plain) = seconds_of(
                [&] {
                    if (is_ours)
                        write_checkpoint(path, header, discs, communicator, {n_threads});
                    else
                        write_plainly(path, header, discs, n_threads, communicator);
                },
                path, communicator);
        ratios.push_back(plain / ours);
        if (communicator.is_root())
            std::printf("round %d  HDF5 %.2f s, plain %.2f s, ratio of speeds %.2f\n", round, ours,
                        plain, plain / ours);
    }
    if (communicator.is_root())
        std::printf("%d ranks, %llu discs: median ratio %.2f\n", communicator.size(),
                    static_cast<unsigned long long>(n_discs), median(ratios));
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    start_io();
    const Mpi mpi(argc, argv);
    const auto argument = [&](int k, const char* otherwise) {
        return argc > k ? argv[k] : otherwise;
    };
    return run_on_all(Communicator::world(), [&](const Communicator& communicator) {
        return compare(argument(1, "."), std::strtoull(argument(2, "20000000"), nullptr, 10),
                       std::atoi(argument(3, "7")), std::atoi(argument(4, "1")), communicator);
    });
}
