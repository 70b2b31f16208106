// SPDX-License-Identifier: BSD-3-Clause
// Messages from any rank to any rank, and from all ranks to rank 0 in bounded memory.
//
// send_to_owners announces sizes with one MPI_Alltoall of 8 bytes per pair of ranks, then sends
// only the messages that are not empty. The announcement takes longer with more ranks (some 30 us
// for 1000). The NBX algorithm (Hoefler, Siebert, Lumsdaine 2010) needs no announcement but a
// barrier, which takes as long unless there are many thousands of ranks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/errors.hpp"
#include "parallel/communicator.hpp"
#include "parallel/received.hpp"

namespace carrom {

namespace detail {
/// Returns the numbers of bytes that each rank will send to this rank. `bytes_to` are the numbers
/// of bytes that this rank will send to each rank. **Collective.**
std::vector<std::uint64_t> announce(const Communicator& communicator,
                                    std::span<const std::uint64_t> bytes_to);
/// Sends and receives parcels of known sizes: parcel k of `out` goes to rank k, and parcel k of
/// `in` comes from rank k.
void move_parcels(const Communicator& communicator, std::span<const std::span<const std::byte>> out,
                  std::span<const std::span<std::byte>> in);
/// Returns every rank's `value` on rank 0, and an empty list on other ranks. **Collective.**
std::vector<std::uint64_t> gather_to_root(const Communicator& communicator, std::uint64_t value);
/// Sends one piece of a stream. Waits until it is being received, so that pieces do not pile up.
void send_piece(const Communicator& communicator, std::span<const std::byte> piece);
void receive_piece(const Communicator& communicator, int sender, std::span<std::byte> piece);
} // namespace detail

/// Sends out[k] to rank k (this one included; empty lists cost nothing) and returns the items that
/// arrive, grouped by sender in rank order. `out` has size() lists. **Collective.**
template <Message T>
Received<T> send_to_owners(const Communicator& communicator,
                           const std::vector<std::vector<T>>& out) {
    const auto n_ranks = static_cast<std::size_t>(communicator.size());
    ensure(out.size() == n_ranks, "sending to owners needs one list of items per rank");
    std::vector<std::uint64_t> bytes_to(n_ranks);
    std::vector<std::span<const std::byte>> parcels(n_ranks);
    for (std::size_t k = 0; k < n_ranks; ++k) {
        parcels[k] = std::as_bytes(std::span(out[k]));
        bytes_to[k] = parcels[k].size();
    }
    Received<T> in;
    for (const std::uint64_t bytes : detail::announce(communicator, bytes_to))
        in.offsets.push_back(in.offsets.back() + bytes / sizeof(T));
    in.items.resize(in.offsets.back());
    std::vector<std::span<std::byte>> places(n_ranks);
    for (std::size_t k = 0; k < n_ranks; ++k)
        places[k] = std::as_writable_bytes(
            std::span(in.items).subspan(in.offsets[k], in.offsets[k + 1] - in.offsets[k]));
    detail::move_parcels(communicator, parcels, places);
    return in;
}

/// Passes the items of all ranks to `consume(std::span<const T>)` on rank 0, in rank order, in
/// chunks of 1 to `max_chunk` items; rank 0 holds one chunk at a time, the other ranks wait for
/// their turn. If `consume` throws, the exception must end the run: the others are still sending.
/// **Collective.**
template <Message T, class Consume>
void stream_to_root(const Communicator& communicator, std::span<const T> mine, Consume&& consume,
                    std::size_t max_chunk) {
    ensure(max_chunk > 0, "a stream needs chunks of at least one item");
    const std::vector<std::uint64_t> counts = detail::gather_to_root(communicator, mine.size());
    for (std::size_t done = 0; done < mine.size(); done += max_chunk) {
        const std::span<const T> piece = mine.subspan(done,
                                                      std::min(max_chunk, mine.size() - done));
        if (communicator.is_root())
            consume(piece);
        else
            detail::send_piece(communicator, std::as_bytes(piece));
    }
    std::vector<T> chunk;
    for (std::size_t sender = 1; sender < counts.size(); ++sender) {
        for (std::size_t left = counts[sender]; left > 0; left -= chunk.size()) {
            chunk.resize(std::min(max_chunk, left));
            detail::receive_piece(communicator, static_cast<int>(sender),
                                  std::as_writable_bytes(std::span(chunk)));
            consume(std::span<const T>(chunk));
        }
    }
}

template <Message T, class Consume>
void stream_to_root(const Communicator& communicator, const std::vector<T>& mine, Consume&& consume,
                    std::size_t max_chunk) {
    stream_to_root(communicator, std::span<const T>(mine), consume, max_chunk);
}

} // namespace carrom
