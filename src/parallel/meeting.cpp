// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/meeting.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <thread>

#include "core/errors.hpp"
#include "parallel/handle.hpp"
#include "parallel/mpi.hpp"

namespace carrom {

namespace {

/// A rank that has met the others and left at once may be ahead of their messages.
constexpr std::chrono::seconds grace(10);

/// The rank that has departed, if one has said so; -1 else.
int departed_rank(MPI_Comm comm) {
    int is_there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, tag::departure, comm, &is_there, &status);
    return is_there != 0 ? status.MPI_SOURCE : -1;
}

void wait_unless_departed(MPI_Request& request, MPI_Comm comm, std::string_view call) {
    using Clock = std::chrono::steady_clock;
    int is_done = 0, departed = -1;
    Clock::time_point noticed;
    auto pause = std::chrono::microseconds(1);
    while (MPI_Test(&request, &is_done, MPI_STATUS_IGNORE) == MPI_SUCCESS && is_done == 0) {
        if (departed < 0) {
            departed = departed_rank(comm);
            noticed = Clock::now();
        } else if (Clock::now() - noticed > grace) {
            abort_from_mistake("rank " + std::to_string(departed) +
                               " has left, and this one waits for it in " + std::string(call) +
                               ", which all ranks must call");
        }
        std::this_thread::sleep_for(pause);
        pause = std::min(2 * pause, std::chrono::microseconds(2000));
    }
}

} // namespace

std::uint64_t hash_of_argument(std::string_view text) {
    return std::hash<std::string_view>{}(text);
}

void meet(const Communicator& communicator, std::string_view call, std::uint64_t argument) {
    Communicator::Handle& handle = communicator.handle();
    if (handle.is_alone() || handle.size == 1) return;
    const std::uint64_t mine = hash_of_argument(call) ^ (argument * 0x9e3779b97f4a7c15u);
    const std::array<std::uint64_t, 2> words = {mine, ~mine};
    std::array<std::uint64_t, 2> least{};
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallreduce(words.data(), least.data(), 2, MPI_UINT64_T, MPI_MIN, handle.comm, &request);
    wait_unless_departed(request, handle.comm, call);
    if (least[0] == ~least[1]) return;
    throw InputError({{std::string(call), 0,
                       "ranks make different calls, or with other arguments; all must make the "
                       "same ones in the same order"}});
}

struct Departure::Messages {
    std::vector<MPI_Request> requests;
};

Departure::Departure(const Communicator& communicator)
    : communicator_(communicator), messages_(std::make_unique<Messages>()) {}

void Departure::leave() {
    Communicator::Handle& handle = communicator_.handle();
    if (handle.is_alone() || !messages_->requests.empty()) return;
    for (int rank = 0; rank < handle.size; ++rank) {
        if (rank == handle.rank) continue;
        MPI_Isend(nullptr, 0, MPI_BYTE, rank, tag::departure, handle.comm,
                  &messages_->requests.emplace_back(MPI_REQUEST_NULL));
    }
}

Departure::~Departure() {
    if (has_mpi_ended()) return;
    leave();
    Communicator::Handle& handle = communicator_.handle();
    if (handle.is_alone()) return;
    for (int rank = 0; rank < handle.size; ++rank)
        if (rank != handle.rank)
            MPI_Recv(nullptr, 0, MPI_BYTE, rank, tag::departure, handle.comm, MPI_STATUS_IGNORE);
    MPI_Waitall(static_cast<int>(messages_->requests.size()), messages_->requests.data(),
                MPI_STATUSES_IGNORE);
}

} // namespace carrom
