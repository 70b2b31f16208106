// SPDX-License-Identifier: BSD-3-Clause
// The implementation of a Communicator, and sending of data of any size in messages of limited
// size.
//
// `start_send` splits data of any size and counts its messages. exchange.cpp,
// neighbour_exchange.cpp and meeting.cpp also call MPI directly to send single messages.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <mpi.h>

#include "parallel/communicator.hpp"

namespace carrom {

/// Tags of messages. Successive neighbour exchanges get tags from
/// `first_free` to `last`, and then again from `first_free` on.
namespace tag {
inline constexpr int any_to_any = 1;
inline constexpr int stream = 2;
inline constexpr int departure = 3;
inline constexpr int first_free = 16;
inline constexpr int last = 32767; ///< the largest tag that every MPI allows
} // namespace tag

struct Communicator::Handle {
    /// MPI_COMM_NULL means this process alone, without MPI.
    Handle(MPI_Comm duplicated, std::size_t limit);
    ~Handle();
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;

    /// Whether MPI has not been started, so that none of its functions may be called.
    bool is_alone() const { return comm == MPI_COMM_NULL; }

    MPI_Comm comm;
    int rank = 0;
    int size = 1;
    std::size_t max_message;
    int next_tag = tag::first_free;
    Traffic traffic;
};

using Requests = std::vector<MPI_Request>;

/// Starts sending `bytes` in messages of at most `max_message` bytes; sends no message if there are
/// no bytes. The bytes must stay unchanged until `wait_for` has returned.
void start_send(Communicator::Handle& handle, std::span<const std::byte> bytes, int to,
                int message_tag, Requests& requests);

/// Starts receiving the bytes that `start_send` sends with the same tag and number of bytes.
void start_receive(Communicator::Handle& handle, std::span<std::byte> bytes, int from,
                   int message_tag, Requests& requests);

/// Waits for all of `requests` and empties the list.
void wait_for(Requests& requests);

/// Waits for `request`, without a limit if `failure` is empty. Otherwise this rank has failed, and
/// other ranks may be waiting for it in another operation. So after `patience_seconds` it prints
/// `failure` and aborts all ranks with `code`.
void wait_or_abort(MPI_Request& request, const std::string& failure, double patience_seconds,
                   int code);

/// Prints `text`, which describes a wrong use of the library, and aborts all ranks with code 70.
[[noreturn]] void abort_from_mistake(std::string_view text);

/// From now on an MPI error in `comm` prints this rank and the error's text, and aborts all ranks.
void abort_on_errors_of(MPI_Comm comm);

/// Calls `act` on successive pieces of at most `limit` bytes.
template <class Byte, class Act>
void for_pieces(std::span<Byte> bytes, std::size_t limit, const Act& act) {
    for (std::size_t done = 0; done < bytes.size(); done += limit)
        act(bytes.subspan(done, std::min(limit, bytes.size() - done)));
}

} // namespace carrom
