// SPDX-License-Identifier: BSD-3-Clause
// Sorts records by id, piece by piece. The ids are 0 .. n-1; the records can be on any ranks, in
// any order.
//
// The ids are cut into pieces whose length is a power of two, and each rank owns a run of whole
// pieces. A counting sort finds the piece of each record. Then, round after round, each rank gets
// its next piece in order. So there is never a second copy of all records, and a piece is in cache
// when its rank uses it. Records are sent for several rounds together, so that ranks rarely wait
// for each other. Cost: 4 bytes per record, and memory for the records of some pieces. Each record
// is read three times on its rank, and sent once if another rank owns it.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/errors.hpp"
#include "parallel/communicator.hpp"
#include "parallel/exchange.hpp"
#include "parallel/slabs.hpp"

namespace carrom {

/// Cuts the ids into pieces, and assigns runs of consecutive pieces to the owners: all ranks, or
/// fewer ranks that are spread evenly. The runs of owners differ by at most one piece, and longer
/// runs come first. Each rank sends records to all owners, so fewer owners mean fewer messages.
class Pieces {
public:
    static constexpr std::uint64_t least_rows = 1 << 10, most_rows = 1 << 15;

    Pieces(std::uint64_t n, int n_ranks) : Pieces(n, n_ranks, n_ranks) {}
    Pieces(std::uint64_t n, int n_ranks, int n_owners)
        : n_(n), n_ranks_(n_ranks), n_owners_(n_owners),
          rows_(std::clamp(std::bit_floor(n / (8 * static_cast<std::uint64_t>(n_owners)) + 1),
                           least_rows, most_rows)) {}

    std::uint64_t count() const { return (n_ + rows_ - 1) / rows_; }
    std::uint64_t rows() const { return rows_; }
    std::uint64_t of(std::uint64_t id) const { return id / rows_; }
    /// The first id of a piece. For the piece count() it is n.
    std::uint64_t begin(std::uint64_t piece) const { return std::min(piece * rows_, n_); }
    /// The first piece of a rank. For the rank `n_ranks` it is count().
    std::uint64_t first_of(int rank) const {
        const auto n_before = (std::int64_t{rank} * n_owners_ + n_ranks_ - 1) / n_ranks_;
        return slab_begin(static_cast<int>(n_before), count(), n_owners_);
    }
    /// The largest number of pieces of any rank.
    std::uint64_t n_rounds() const { return first_of(1); }

private:
    std::uint64_t n_;
    int n_ranks_, n_owners_;
    std::uint64_t rows_;
};

/// Provides each rank with its sorted pieces, one in each round.
template <Message T, class IdOf> class PieceStream {
public:
    /// `id_of(record)` returns the id. Each id 0 .. n-1 must occur exactly once on all ranks
    /// together; this is tested for each piece. `records` must stay unchanged as long as the stream
    /// is used.
    PieceStream(const Communicator& communicator, std::span<const T> records, std::uint64_t n,
                const IdOf& id_of)
        : PieceStream(communicator, records, Pieces(n, communicator.size()), n, id_of) {}
    PieceStream(const Communicator& communicator, std::span<const T> records, const Pieces& pieces,
                std::uint64_t n, const IdOf& id_of)
        : communicator_(communicator), records_(records), id_of_(id_of), n_(n), pieces_(pieces),
          out_(static_cast<std::size_t>(communicator.size())) {
        ensure(records.size() < std::numeric_limits<std::uint32_t>::max(),
               "too many records on a rank");
        sort_by_piece();
    }

    const Pieces& pieces() const { return pieces_; }

    /// Returns this rank's piece of the next round, sorted by id from `begin()` on; empty if this
    /// rank has no more pieces. Valid until the next call. Must be called n_rounds() times by
    /// every rank. **Collective.**
    std::span<const T> next() {
        const int me = communicator_.rank();
        const std::uint64_t mine = pieces_.first_of(me) + round_;
        const bool has_more = mine < pieces_.first_of(me + 1);
        begin_ = pieces_.begin(has_more ? mine : pieces_.count());
        piece_.resize(has_more ? pieces_.begin(mine + 1) - begin_ : 0);
        is_placed_.assign(piece_.size(), 0);
        std::size_t n_placed = 0;
        if (has_more) {
            for_each_of(mine, [&](const T& record) { place(record); });
            n_placed = n_in(mine);
        }
        if (communicator_.size() > 1) {
            if (round_ % rounds_per_exchange == 0) exchange();
            if (has_more) n_placed += place_received(mine);
        }
        ++round_;
        ensure(n_placed == piece_.size(), "a piece has missing or surplus records");
        return piece_;
    }
    std::uint64_t begin() const { return begin_; }

private:
    static constexpr std::uint64_t rounds_per_exchange = 8;
    /// Records are prefetched this many places ahead, because they are scattered in memory
    static constexpr std::size_t records_ahead = 64;

    void sort_by_piece() {
        first_in_order_.assign(pieces_.count() + 1, 0);
        std::vector<std::uint32_t> piece_of(records_.size());
        for (std::size_t i = 0; i < records_.size(); ++i) {
            const std::uint64_t id = id_of_(records_[i]);
            ensure(id < n_, "a record's id is beyond the number of records");
            piece_of[i] = static_cast<std::uint32_t>(pieces_.of(id));
            ++first_in_order_[piece_of[i] + 1];
        }
        for (std::size_t k = 1; k < first_in_order_.size(); ++k)
            first_in_order_[k] += first_in_order_[k - 1];
        std::vector<std::uint32_t> next(first_in_order_.begin(), first_in_order_.end() - 1);
        order_.resize(records_.size());
        for (std::size_t i = 0; i < records_.size(); ++i)
            order_[next[piece_of[i]]++] = static_cast<std::uint32_t>(i);
    }

    std::size_t n_in(std::uint64_t piece) const {
        return first_in_order_[piece + 1] - first_in_order_[piece];
    }

    template <class Act> void for_each_of(std::uint64_t piece, const Act& act) const {
        for_each_between(piece, piece + 1, act);
    }
    template <class Act>
    void for_each_between(std::uint64_t piece, std::uint64_t end, const Act& act) const {
        for (std::size_t k = first_in_order_[piece]; k < first_in_order_[end]; ++k) {
            __builtin_prefetch(&records_[order_[std::min(k + records_ahead, order_.size() - 1)]], 0,
                               2);
            act(records_[order_[k]]);
        }
    }

    void place(const T& record) {
        const std::uint64_t i = id_of_(record) - begin_;
        ensure(i < piece_.size(), "a record has come to another piece than its own");
        ensure(is_placed_[i] == 0, "two records have the same id");
        is_placed_[i] = 1;
        piece_[i] = record;
    }

    /// Exchanges the records of the next rounds' pieces, piece after piece, with all
    /// other ranks.
    void exchange() {
        for (int rank = 0; rank < communicator_.size(); ++rank) {
            std::vector<T>& out = out_[static_cast<std::size_t>(rank)];
            out.clear();
            const std::uint64_t end = pieces_.first_of(rank + 1),
                                piece = std::min(pieces_.first_of(rank) + round_, end);
            if (rank != communicator_.rank())
                for_each_between(piece, std::min(piece + rounds_per_exchange, end),
                                 [&](const T& record) { out.push_back(record); });
        }
        received_ = send_to_owners(communicator_, out_);
        n_taken_.assign(received_.n_senders(), 0);
    }

    /// Places the records of the piece from every sender, and returns their number.
    std::size_t place_received(std::uint64_t piece) {
        std::size_t n_placed = 0;
        for (std::size_t k = 0; k < received_.n_senders(); ++k) {
            for (const T& record : received_.from(k).subspan(n_taken_[k])) {
                if (pieces_.of(id_of_(record)) != piece) break;
                place(record);
                ++n_taken_[k];
                ++n_placed;
            }
        }
        return n_placed;
    }

    const Communicator& communicator_;
    std::span<const T> records_;
    IdOf id_of_;
    std::uint64_t n_;
    Pieces pieces_;
    std::vector<std::uint32_t> order_; ///< indices of this rank's records, sorted by piece
    std::vector<std::uint32_t>
        first_in_order_; ///< first place of each piece in `order_`; then its size
    std::uint64_t round_ = 0, begin_ = 0;
    std::vector<T> piece_;
    std::vector<std::uint8_t> is_placed_;
    std::vector<std::vector<T>> out_;
    Received<T> received_;             ///< records from each sender, in the order of pieces
    std::vector<std::size_t> n_taken_; ///< number of records already placed, for each sender
};

} // namespace carrom
