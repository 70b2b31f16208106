// SPDX-License-Identifier: BSD-3-Clause
// Rank 0 makes the file with all its structure and takes its room on disk; then the ranks fill in
// the columns. So what is written side by side is numbers alone, at places that no longer move:
// plain writes, without HDF5 or MPI-IO, which leave nobody waiting where one rank's fail. A rank's
// pieces begin at pages of their own, so that nodes whose caches know nothing of each other do not
// share any.
#include <algorithm>
#include <array>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "io/checkpoint.hpp"
#include "io/checkpoint_structure.hpp"
#include "io/files.hpp"
#include "io/seal.hpp"
#include "parallel/pieces.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t bytes_of_structure = 1 << 20;
static_assert(Pieces::least_rows % rows_per_block == 0, "pieces are made of whole blocks");

/// The file beside its place; gone again unless it was renamed, so that half a file takes no room
/// on a full disk.
class PartialFile {
public:
    PartialFile(std::string path, const Communicator& communicator)
        : path_(std::move(path)), is_mine_(communicator.is_root()) {
        if (is_mine_) ::unlink(path_.c_str());
    }
    ~PartialFile() {
        if (is_mine_) ::unlink(path_.c_str());
    }
    PartialFile(const PartialFile&) = delete;
    PartialFile& operator=(const PartialFile&) = delete;
    const std::string& path() const { return path_; }

private:
    std::string path_;
    bool is_mine_;
};

/// Writes packed pieces in the background, one at a time; knows of the first failure and writes
/// nothing after it.
class PieceWriter {
public:
    PieceWriter(const std::string& path, const std::vector<DiscTarget>& targets)
        : file_(path, O_WRONLY), targets_(targets) {}
    ~PieceWriter() {
        if (under_way_.valid()) under_way_.wait();
    }

    /// One buffer for each target; good until the call after the next one.
    using Buffers = std::vector<std::vector<std::byte>>;

    /// Waits for the piece before, then lets `buffers` be written as rows from `first` on.
    void write(std::uint64_t first, const Buffers& buffers) {
        if (!wait()) return;
        const bool starts_sync = ++n_pieces_ % pieces_between_syncs == 0;
        under_way_ = std::async(
            std::launch::async | std::launch::deferred, [this, first, &buffers, starts_sync] {
                for (std::size_t k = 0; k < targets_.size(); ++k)
                    file_.write(buffers[k],
                                targets_[k].part.begin + first * targets_[k].part.bytes_per_row);
                if (starts_sync) file_.start_sync();
            });
    }

    /// Waits for what is under way and brings all to disk: on several nodes it is in caches of
    /// their own. Throws FileError.
    void finish() {
        if (!wait()) throw FileError(failure_);
        file_.sync();
    }

private:
    static constexpr std::uint64_t pieces_between_syncs = 8;

    bool wait() {
        try {
            if (under_way_.valid()) under_way_.get();
        } catch (const FileError& error) {
            failure_ = error.what();
        }
        return failure_.empty();
    }

    Descriptor file_;
    const std::vector<DiscTarget>& targets_;
    std::future<void> under_way_;
    std::string failure_;
    std::uint64_t n_pieces_ = 0;
};

/// What is summed over discs while they are at hand; words, so that threads and ranks may add up.
class Sums {
public:
    explicit Sums(std::size_t n_targets) : words_(4 + 2 * n_targets, 0) {}

    /// `spins`: of discs that turn.
    void add(std::span<const Disc> discs, const SpinsOfPieces& spins) {
        for (const Disc& disc : discs) {
            words_[0] += disc.wall_collisions;
            words_[1] += disc.pair_collisions;
        }
        add(2, hash_of(discs));
        if (spins.values.empty()) return;
        for (const Disc& disc : discs) add(2, hash_of_spin(disc.id, spins.of(disc)));
    }
    void add_checksum(std::size_t target, const StateHash& checksum) {
        add(4 + 2 * target, checksum);
    }
    void add(const Sums& other) {
        for (std::size_t k = 0; k < words_.size(); ++k) words_[k] += other.words_[k];
    }
    void add_over(const Communicator& communicator) { communicator.sum(words_); }

    StateSums state() const { return {words_[0], words_[1], {words_[2], words_[3]}}; }
    StateHash checksum(std::size_t target) const {
        return {words_[4 + 2 * target], words_[5 + 2 * target]};
    }

private:
    void add(std::size_t k, const StateHash& hash) {
        words_[k] += hash.low;
        words_[k + 1] += hash.high;
    }

    std::vector<std::uint64_t> words_;
};

/// Takes a piece apart into the targets' bytes, block by block; threads share the blocks.
void pack(std::span<const Disc> piece, std::uint64_t first, const SpinsOfPieces& spins,
          const std::vector<DiscTarget>& targets, PieceWriter::Buffers& buffers, Sums& sums,
          int n_threads) {
    for (std::size_t k = 0; k < targets.size(); ++k)
        buffers[k].resize(piece.size() * targets[k].part.bytes_per_row);
    const std::size_t n_blocks = (piece.size() + rows_per_block - 1) / rows_per_block;
#pragma omp parallel num_threads(n_threads)
    {
        Sums mine(targets.size());
#pragma omp for schedule(static)
        for (std::size_t block = 0; block < n_blocks; ++block) {
            const std::size_t row = block * rows_per_block;
            const std::span<const Disc> discs = piece.subspan(
                row, std::min<std::size_t>(rows_per_block, piece.size() - row));
            mine.add(discs, spins);
            for (std::size_t k = 0; k < targets.size(); ++k) {
                const std::size_t width = targets[k].part.bytes_per_row;
                const std::span<std::byte> bytes =
                    std::span(buffers[k]).subspan(row * width, discs.size() * width);
                targets[k].put(discs, bytes.data());
                mine.add_checksum(k, checksum_of_block(bytes, first / rows_per_block + block));
            }
        }
#pragma omp critical(sums_of_a_piece)
        sums.add(mine);
    }
}

struct DiscSpin {
    DiscId id = 0;
    double spin = 0;
};

/// Brings each disc's spin to the rank whose pieces have it. **Collective.**
SpinsOfPieces in_pieces(std::span<const Disc> discs, std::span<const double> spins,
                        std::uint64_t n_discs, const Communicator& communicator) {
    ensure(spins.size() == discs.size(), "spins do not run along the discs");
    std::vector<DiscSpin> records;
    records.reserve(discs.size());
    for (std::size_t i = 0; i < discs.size(); ++i) records.push_back({discs[i].id, spins[i]});
    PieceStream stream(communicator, std::span<const DiscSpin>(records), n_discs,
                       [](const DiscSpin& record) { return record.id; });
    const Pieces& pieces = stream.pieces();
    SpinsOfPieces mine{pieces.begin(pieces.first_of(communicator.rank())), {}};
    for (std::uint64_t round = 0; round < pieces.n_rounds(); ++round)
        for (const DiscSpin& record : stream.next()) mine.values.push_back(record.spin);
    return mine;
}

/// Fills the columns: the ranks' pieces, each written while the next one is taken apart.
/// **Collective.**
Sums write_discs(const std::string& path, const std::vector<DiscTarget>& targets,
                 std::span<const Disc> discs, const SpinsOfPieces& spins, std::uint64_t n_discs,
                 int n_threads, const Communicator& communicator) {
    std::optional<PieceWriter> writer;
    on_all(communicator, path, ExitCode::output_failure, [&] { writer.emplace(path, targets); });
    PieceStream stream(communicator, discs, n_discs, [](const Disc& disc) { return disc.id; });
    Sums sums(targets.size());
    std::array<PieceWriter::Buffers, 2> buffers;
    buffers.fill(PieceWriter::Buffers(targets.size()));
    for (std::uint64_t round = 0; round < stream.pieces().n_rounds(); ++round) {
        const std::span<const Disc> piece = stream.next();
        if (piece.empty()) continue;
        pack(piece, stream.begin(), spins, targets, buffers[round % 2], sums, n_threads);
        writer->write(stream.begin(), buffers[round % 2]);
    }
    on_all(communicator, path, ExitCode::output_failure, [&] { writer->finish(); });
    sums.add_over(communicator);
    return sums;
}

} // namespace

void write_checkpoint(const std::string& path, CheckpointHeader header, std::span<const Disc> discs,
                      const Communicator& communicator, int n_threads, const StoredSamples& samples,
                      std::span<const double> spins) {
    header.n_discs = communicator.sum(std::uint64_t{discs.size()});
    const SpinsOfPieces spins_of_pieces = header.has_spins ? in_pieces(discs, spins, header.n_discs,
                                                                       communicator)
                                                           : SpinsOfPieces{};
    std::vector<DiscTarget> targets = disc_targets(header, samples, spins_of_pieces);
    const PartialFile partial(path + ".partial", communicator);
    HeaderPlaces places;
    on_root(communicator, path, ExitCode::output_failure, [&] {
        std::uint64_t bytes = bytes_of_structure + samples.sums.size() * sizeof(std::int64_t) +
                              header.species.size() * sizeof(Species);
        for (const DiscTarget& target : targets)
            bytes += target.part.rows * target.part.bytes_per_row;
        check_room(folder_of(path), bytes);
        places = create_structure(partial.path(), header, samples, targets);
        reserve(partial.path());
    });
    for (DiscTarget& target : targets) communicator.broadcast(target.part.begin);
    const Sums sums = write_discs(partial.path(), targets, discs, spins_of_pieces, header.n_discs,
                                  n_threads, communicator);
    on_root(communicator, path, ExitCode::output_failure, [&] {
        fill_in(partial.path(), places, sums.state());
        std::vector<SealedPart> parts;
        for (std::size_t k = 0; k < targets.size(); ++k) {
            parts.push_back(targets[k].part);
            parts.back().checksum = sums.checksum(k);
        }
        std::sort(parts.begin(), parts.end(),
                  [](const SealedPart& a, const SealedPart& b) { return a.begin < b.begin; });
        seal(partial.path(), parts);
        rename_durably(partial.path(), path);
    });
}

} // namespace carrom
