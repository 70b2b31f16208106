// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/exchange.hpp"

#include <cstring>

#include "parallel/handle.hpp"

namespace carrom::detail {

std::vector<std::uint64_t> announce(const Communicator& communicator,
                                    std::span<const std::uint64_t> bytes_to) {
    Communicator::Handle& handle = communicator.handle();
    std::vector<std::uint64_t> bytes_from(bytes_to.begin(), bytes_to.end());
    ++handle.traffic.collectives;
    if (handle.is_alone()) return bytes_from;
    MPI_Alltoall(bytes_to.data(), 1, MPI_UINT64_T, bytes_from.data(), 1, MPI_UINT64_T, handle.comm);
    return bytes_from;
}

void move_parcels(const Communicator& communicator, std::span<const std::span<const std::byte>> out,
                  std::span<const std::span<std::byte>> in) {
    Communicator::Handle& handle = communicator.handle();
    const auto own = static_cast<std::size_t>(handle.rank);
    Requests requests;
    // Start with the next rank, so that not all ranks send to rank 0 first.
    for (std::size_t shift = 1; shift < out.size(); ++shift) {
        const std::size_t from = (own + out.size() - shift) % out.size();
        start_receive(handle, in[from], static_cast<int>(from), tag::any_to_any, requests);
    }
    for (std::size_t shift = 1; shift < out.size(); ++shift) {
        const std::size_t to = (own + shift) % out.size();
        start_send(handle, out[to], static_cast<int>(to), tag::any_to_any, requests);
    }
    if (!out[own].empty()) std::memcpy(in[own].data(), out[own].data(), out[own].size());
    wait_for(requests);
}

std::vector<std::uint64_t> gather_to_root(const Communicator& communicator, std::uint64_t value) {
    Communicator::Handle& handle = communicator.handle();
    std::vector<std::uint64_t> values(communicator.is_root() ? static_cast<std::size_t>(handle.size)
                                                             : 0);
    ++handle.traffic.collectives;
    if (handle.is_alone()) return {value};
    MPI_Gather(&value, 1, MPI_UINT64_T, values.data(), 1, MPI_UINT64_T, 0, handle.comm);
    return values;
}

void send_piece(const Communicator& communicator, std::span<const std::byte> piece) {
    Communicator::Handle& handle = communicator.handle();
    for_pieces(piece, handle.max_message, [&handle](std::span<const std::byte> part) {
        ++handle.traffic.messages;
        handle.traffic.bytes += part.size();
        MPI_Ssend(part.data(), static_cast<int>(part.size()), MPI_BYTE, 0, tag::stream,
                  handle.comm);
    });
}

void receive_piece(const Communicator& communicator, int sender, std::span<std::byte> piece) {
    Communicator::Handle& handle = communicator.handle();
    for_pieces(piece, handle.max_message, [&handle, sender](std::span<std::byte> part) {
        MPI_Recv(part.data(), static_cast<int>(part.size()), MPI_BYTE, sender, tag::stream,
                 handle.comm, MPI_STATUS_IGNORE);
    });
}

} // namespace carrom::detail
