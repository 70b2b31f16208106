// SPDX-License-Identifier: BSD-3-Clause
// Ranks share the writing of discs (checkpoint.hpp). The offsets of data sets in the file are
// fixed, so writing never changes HDF5's metadata. Each rank's pieces begin at a page boundary,
// because caches of different nodes are not coherent.
//
// For independent transfers only rank 0 opens the file by HDF5, to make and to complete it. HDF5
// reports the offsets of the data in the file, and ranks write them there. So only one rank writes
// HDF5's mark of an open file, and no call waits for another rank: each rank detects its own
// failure, and then all agree. With one handle for all ranks, HDF5 1.10 waits for ever if rank 0
// cannot write that mark when all close the file. If there are many ranks, only some of them
// (most_writers) write, and each rank sends discs to each writer.
//
// Collective transfers need one handle for all ranks. If one rank fails, the others wait inside
// HDF5; then `agree`, or a deadline for closing, ends the run with the same exit code.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "io/checkpoint.hpp"
#include "io/checkpoint_structure.hpp"
#include "io/checksums.hpp"
#include "io/files.hpp"
#include "parallel/mpi.hpp"
#include "parallel/pieces.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t bytes_of_structure = 1 << 20;
constexpr int most_writers = 64;
static_assert(Pieces::least_rows % rows_per_block == 0, "pieces are made of whole blocks");

/// Ends all ranks if HDF5 does not finish closing a shared file within 30 seconds.
class Deadline {
public:
    Deadline() {
        struct sigaction action{};
        action.sa_handler = [](int) {
            abort_from_signal("carrom: a checkpoint cannot be closed: ranks wait for each other\n",
                              static_cast<int>(ExitCode::output_failure));
        };
        ::sigaction(SIGALRM, &action, &before_);
        ::alarm(patience_seconds);
    }
    ~Deadline() {
        ::alarm(0);
        ::sigaction(SIGALRM, &before_, nullptr);
    }
    Deadline(const Deadline&) = delete;
    Deadline& operator=(const Deadline&) = delete;

private:
    static constexpr unsigned patience_seconds = 30;
    struct sigaction before_{};
};

/// This rank's rows as bytes of the file, in one buffer for each data set.
struct Batch {
    std::uint64_t first = 0, n_rows = 0;
    std::vector<std::vector<std::byte>> buffers;
};

/// This rank's access to the file. It stores its first failure, and writes nothing afterwards.
class RankWriter {
public:
    /// For independent transfers only writers keep the file open. **Collective.**
    RankWriter(const std::string& path, const std::vector<DiscTarget>& targets, bool is_collective,
               bool is_writer, const Communicator& communicator)
        : path_(path), targets_(targets), communicator_(communicator),
          places_(is_collective ? std::vector<std::uint64_t>() : find_places()) {
        on_all_ranks([&] { // if one rank fails, all ranks throw
            if (is_writer || is_collective) bytes_.emplace(path_, O_WRONLY);
        });
        if (!is_collective) return;
        on_all_ranks([&] { file_ = h5::SharedFile(path_, h5::Access::write, communicator_); });
        on_all_ranks([&] {
            for (const DiscTarget& target : targets_)
                datasets_.push_back(h5::open_dataset(file_.id(), target.path));
        });
    }

    /// Writes a batch at its place in the file, if no earlier write failed. Not collective.
    void write(const Batch& batch) {
        if (!failure_.empty()) return;
        try {
            for (std::size_t k = 0; k < targets_.size(); ++k)
                bytes_->write(batch.buffers[k],
                              places_[k] + batch.first * targets_[k].bytes_per_row);
            if (++n_batches_ % batches_between_syncs == 0) bytes_->start_sync();
        } catch (const FileError& error) {
            failure_ = error.what();
        }
    }

    /// Writes all ranks' batches together. If a rank fails, it leaves HDF5's collective write, and
    /// the others wait in it until `agree` ends the run. **Collective.**
    void write_together(const Batch& batch) {
        for (std::size_t k = 0; k < targets_.size(); ++k)
            on_all_ranks([&] {
                h5::write_rows(datasets_[k].id(), {batch.first, batch.first + batch.n_rows},
                               targets_[k].type, batch.buffers[k].data(), h5::Transfer::collective);
            });
    }

    /// Syncs this rank's bytes to disk, because each node has its own cache. Then closes the file.
    /// **Collective.**
    void finish() {
        on_all_ranks([&] {
            if (!failure_.empty()) throw FileError(failure_);
            if (bytes_) bytes_->sync();
        });
        if (datasets_.empty()) return;
        datasets_.clear();
        on_all_ranks([&] {
            std::optional<Deadline> deadline;
            if (communicator_.size() > 1) deadline.emplace();
            file_.close();
        });
    }

private:
    static constexpr std::uint64_t batches_between_syncs = 8;

    template <class Act> void on_all_ranks(const Act& act) {
        on_all(communicator_, path_, ExitCode::output_failure, act);
    }
    /// Finds where the bytes of each target begin in the file. **Collective.**
    std::vector<std::uint64_t> find_places() const {
        std::vector<std::uint64_t> places;
        on_root(communicator_, path_, ExitCode::output_failure, [&] {
            const h5::File file = h5::open_file(path_, h5::Access::read);
            for (const DiscTarget& target : targets_) {
                const h5::Dataset dataset = h5::open_dataset(file.id(), target.path);
                const haddr_t place = H5Dget_offset(dataset.id());
                if (place == HADDR_UNDEF && H5Dget_storage_size(dataset.id()) > 0)
                    throw FileError("has no place for " + target.path);
                places.push_back(place);
            }
        });
        communicator_.broadcast(places);
        return places;
    }

    std::string path_;
    const std::vector<DiscTarget>& targets_;
    const Communicator& communicator_;
    std::vector<std::uint64_t> places_; ///< for each target, where its bytes begin in the file
    std::optional<Descriptor> bytes_;
    h5::SharedFile file_; ///< the file that collective transfers use, with its data sets
    std::vector<h5::Dataset> datasets_;
    std::string failure_;
    std::uint64_t n_batches_ = 0;
};

void add(std::span<const DiscState> discs, const SideOfPieces& side, StateSums& sums) {
    for (const DiscState& disc : discs)
        sums[place_of_collisions] += {disc.wall_collisions, disc.pair_collisions};
    sums[place_of_hash] += hash_of(discs);
    side.columns.for_each([&](SideColumn column) {
        for (const DiscState& disc : discs)
            sums[place_of_hash] += hash_of(column, disc.id, side.of(column, disc));
    });
}

/// Converts a piece's discs to the targets' bytes, appends these to the batch, and adds to `sums`.
/// New threads share this work. The calling thread first calls `first_of_all`, which writes the
/// previous batch, and then takes part.
template <class Act>
void pack(std::span<const DiscState> piece, std::uint64_t first, const SideOfPieces& side,
          const std::vector<DiscTarget>& targets, Batch& batch, StateSums& sums, int n_threads,
          const Act& first_of_all) {
    const std::size_t before = batch.n_rows;
    if (batch.n_rows == 0) batch.first = first;
    batch.n_rows += piece.size();
    for (std::size_t k = 0; k < targets.size(); ++k)
        batch.buffers[k].resize(batch.n_rows * targets[k].bytes_per_row);
    const std::size_t n_blocks = (piece.size() + rows_per_block - 1) / rows_per_block;
    std::atomic<std::size_t> next{0};
    std::mutex adding;
    const auto pack_blocks = [&] {
        StateSums mine(sums.size());
        for (std::size_t block = next++; block < n_blocks; block = next++) {
            const std::size_t row = block * rows_per_block;
            const std::span<const DiscState> discs = piece.subspan(
                row, std::min<std::size_t>(rows_per_block, piece.size() - row));
            add(discs, side, mine);
            for (std::size_t k = 0; k < targets.size(); ++k) {
                const std::size_t width = targets[k].bytes_per_row;
                const std::span<std::byte> bytes = std::span(batch.buffers[k])
                                                       .subspan((before + row) * width,
                                                                discs.size() * width);
                targets[k].put(discs, bytes.data());
                mine[first_checksum + k] += checksum_of_block(bytes,
                                                              first / rows_per_block + block);
            }
        }
        const std::lock_guard lock(adding);
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += mine[k];
    };
    std::vector<std::jthread> threads; // their destructors wait for them
    try {
        for (int k = 0; k < n_threads; ++k) threads.emplace_back(pack_blocks);
        // no further thread can start, so the running threads do all the work
    } catch (const std::system_error&) {
    }
    first_of_all();
    pack_blocks();
}

struct NumberOfDisc {
    DiscId id = 0;
    double number = 0;
};

/// Sends each disc's side columns to the rank whose pieces contain the disc. **Collective.**
SideOfPieces in_pieces(std::span<const DiscState> discs, const SideColumnSet& wanted,
                       const SideSpans& spans, std::uint64_t n_discs,
                       const Communicator& communicator) {
    const Pieces pieces(n_discs, communicator.size());
    SideOfPieces mine{pieces.begin(pieces.first_of(communicator.rank())), {}};
    wanted.for_each([&](SideColumn column) {
        ensure(spans[column].size() == discs.size(), "a column does not run along the discs");
        std::vector<NumberOfDisc> records;
        for (std::size_t i = 0; i < discs.size(); ++i)
            records.push_back({discs[i].id, spans[column][i]});
        PieceStream stream(communicator, std::span<const NumberOfDisc>(records), n_discs,
                           [](const NumberOfDisc& record) { return record.id; });
        std::vector<double> numbers;
        for (std::uint64_t round = 0; round < pieces.n_rounds(); ++round)
            for (const NumberOfDisc& record : stream.next()) numbers.push_back(record.number);
        mine.columns.add(column, std::move(numbers));
    });
    return mine;
}

/// Writes the ranks' pieces to the data sets. Each piece is written while the next one is packed.
/// Collective transfers start after all pieces are packed, one for each data set. **Collective.**
StateSums write_discs(const std::string& path, const std::vector<DiscTarget>& targets,
                      std::span<const DiscState> discs, const SideOfPieces& side,
                      std::uint64_t n_discs, const WriteSettings& settings, int n_writers,
                      const Communicator& communicator) {
    const Pieces pieces(n_discs, communicator.size(), n_writers);
    const int rank = communicator.rank();
    const bool is_writer = pieces.first_of(rank) < pieces.first_of(rank + 1);
    RankWriter writer(path, targets, settings.is_collective, is_writer, communicator);
    PieceStream stream(communicator, discs, pieces, n_discs,
                       [](const DiscState& disc) { return disc.id; });
    StateSums sums(first_checksum + targets.size());
    Batch next, last;
    next.buffers.resize(targets.size());
    last.buffers.resize(targets.size());
    const auto write_last = [&] {
        if (last.n_rows > 0) writer.write(last);
        last.n_rows = 0;
    };
    for (std::uint64_t round = 0; round < stream.pieces().n_rounds(); ++round) {
        const std::span<const DiscState> piece = stream.next();
        if (piece.empty()) continue;
        pack(piece, stream.begin(), side, targets, next, sums, settings.n_threads, write_last);
        if (!settings.is_collective) std::swap(next, last);
    }
    write_last();
    if (settings.is_collective) writer.write_together(next);
    writer.finish();
    sum_over(communicator, sums);
    return sums;
}

} // namespace

void write_checkpoint(const std::string& path, CheckpointHeader header,
                      std::span<const DiscState> discs, const Communicator& communicator,
                      const WriteSettings& settings, const StoredSamples& samples,
                      const SideSpans& columns) {
    header.n_discs = communicator.sum(std::uint64_t{discs.size()});
    const SideOfPieces side = in_pieces(discs, header.columns, columns, header.n_discs,
                                        communicator);
    const std::vector<DiscTarget> targets = disc_targets(header, samples, side);
    on_root(communicator, path, ExitCode::output_failure, [&] { refuse_special(path); });
    const UnfinishedFile partial(path + std::string(unfinished_suffix), communicator.is_root());
    on_root(communicator, path, ExitCode::output_failure, [&] {
        std::uint64_t bytes = bytes_of_structure +
                              (samples.averages.size() + samples.sums.size()) *
                                  sizeof(std::int64_t) +
                              2 * header.shown.species.size() * sizeof(Species);
        for (const DiscTarget& target : targets) bytes += header.n_discs * target.bytes_per_row;
        check_room(folder_of(path), bytes);
        ::unlink(partial.path().c_str()); // a file that a killed run has left
        create_structure(partial.path(), header, samples, targets);
        reserve(partial.path());
    });
    // Side columns and samples are distributed over all ranks, so all ranks must be writers.
    const bool have_numbers = header.columns != SideColumnSet{} || samples.have_first_places ||
                              samples.have_lengths || samples.have_velocities ||
                              samples.have_images;
    const int n_writers = have_numbers ? communicator.size()
                                       : std::min(communicator.size(), most_writers);
    const StateSums sums = write_discs(partial.path(), targets, discs, side, header.n_discs,
                                       settings, n_writers, communicator);
    on_root(communicator, path, ExitCode::output_failure, [&] {
        complete(partial.path(), sums);
        rename_durably(partial.path(), path);
    });
}

} // namespace carrom
