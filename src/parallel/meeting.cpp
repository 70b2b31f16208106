// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/meeting.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <thread>

#include "core/errors.hpp"
#include "core/printable.hpp"
#include "parallel/handle.hpp"
#include "parallel/mpi.hpp"

namespace carrom {

namespace {

/// Time from the detection of a departure to the error message, because messages of the last
/// meeting may be late.
constexpr std::chrono::seconds grace(10);
/// For this time a waiting rank only yields its core, because even the shortest sleep takes longer
/// than a step with few discs.
constexpr std::chrono::microseconds alert(200);
constexpr std::size_t longest_reason = 2000;

/// A rank that has reported its departure, or -1.
int departed_rank(MPI_Comm comm) {
    int is_there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, tag::departure, comm, &is_there, &status);
    return is_there != 0 ? status.MPI_SOURCE : -1;
}

/// Waits for a rank's report of its departure, and returns the reason in it.
std::string reason_of(int rank, MPI_Comm comm) {
    MPI_Status status;
    MPI_Probe(rank, tag::departure, comm, &status);
    int length = 0;
    MPI_Get_count(&status, MPI_BYTE, &length);
    std::string reason(static_cast<std::size_t>(length), ' ');
    MPI_Recv(reason.data(), length, MPI_BYTE, rank, tag::departure, comm, MPI_STATUS_IGNORE);
    return reason;
}

[[noreturn]] void report_missing(int rank, MPI_Comm comm, std::string_view call) {
    const std::string reason = reason_of(rank, comm);
    abort_from_mistake("rank " + std::to_string(rank) + " has left, and this one waits for it in " +
                       std::string(call) + ", which all ranks must call" +
                       (reason.empty() ? "" : "; the error there: " + printable(reason, true)));
}

void wait_unless_departed(MPI_Request& request, MPI_Comm comm, std::string_view call) {
    using Clock = std::chrono::steady_clock;
    int is_done = 0, departed = -1;
    const Clock::time_point start = Clock::now();
    Clock::time_point noticed;
    auto pause = std::chrono::microseconds(1);
    while (MPI_Test(&request, &is_done, MPI_STATUS_IGNORE) == MPI_SUCCESS && is_done == 0) {
        if (departed < 0) {
            departed = departed_rank(comm);
            noticed = Clock::now();
        } else if (Clock::now() - noticed > grace) {
            report_missing(departed, comm, call);
        }
        if (Clock::now() - start < alert) {
            std::this_thread::yield();
            continue;
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
    if (has_mpi_ended())
        throw InputError({{std::string(call), 0,
                           "MPI has ended; end it after the session and its simulations"}});
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
    std::string reason;
    std::vector<MPI_Request> requests;
};

Departure::Departure(const Communicator& communicator)
    : communicator_(communicator), messages_(std::make_unique<Messages>()) {}

void Departure::leave(const std::string& reason) {
    Communicator::Handle& handle = communicator_.handle();
    if (handle.is_alone() || !messages_->requests.empty()) return;
    messages_->reason = reason.substr(0, longest_reason);
    const int length = static_cast<int>(messages_->reason.size());
    for (int rank = 0; rank < handle.size; ++rank) {
        if (rank == handle.rank) continue;
        MPI_Isend(messages_->reason.data(), length, MPI_BYTE, rank, tag::departure, handle.comm,
                  &messages_->requests.emplace_back(MPI_REQUEST_NULL));
    }
}

Departure::~Departure() {
    if (has_mpi_ended()) return;
    leave();
    Communicator::Handle& handle = communicator_.handle();
    if (handle.is_alone()) return;
    for (int rank = 0; rank < handle.size; ++rank)
        if (rank != handle.rank) static_cast<void>(reason_of(rank, handle.comm));
    MPI_Waitall(static_cast<int>(messages_->requests.size()), messages_->requests.data(),
                MPI_STATUSES_IGNORE);
}

Communicator duplicate_of(const Communicator& communicator) {
    if (communicator.handle().is_alone()) return communicator;
    return Communicator::of_fortran(static_cast<int>(MPI_Comm_c2f(communicator.handle().comm)));
}

} // namespace carrom
