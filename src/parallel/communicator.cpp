// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/communicator.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/errors.hpp"
#include "core/exact_sum.hpp"
#include "parallel/handle.hpp"
#include "parallel/native.hpp"

namespace carrom {

namespace {

template <class T>
T reduce(Communicator::Handle& handle, T value, MPI_Datatype type, MPI_Op operation) {
    ++handle.traffic.collectives;
    if (handle.is_alone()) return value;
    T result = value;
    MPI_Allreduce(&value, &result, 1, type, operation, handle.comm);
    return result;
}

/// Returns null if MPI has not been started.
MPI_Comm duplicate_of(MPI_Comm original) {
    int is_started = 0;
    MPI_Comm comm = MPI_COMM_NULL;
    MPI_Initialized(&is_started);
    if (is_started != 0) MPI_Comm_dup(original, &comm);
    return comm;
}

} // namespace

Communicator::Handle::Handle(MPI_Comm duplicated, std::size_t limit)
    : comm(duplicated), max_message(limit) {
    ensure(0 < limit && limit <= largest_message, "the message limit is out of range");
    if (is_alone()) return;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &size);
}

Communicator::Handle::~Handle() {
    if (is_alone()) return;
    int is_over = 0;
    MPI_Finalized(&is_over);
    if (is_over == 0) MPI_Comm_free(&comm);
}

Communicator Communicator::world(std::size_t max_message) {
    MPI_Comm comm = duplicate_of(MPI_COMM_WORLD);
    // Set again, because another part of the program may have changed the handler of the original.
    if (comm != MPI_COMM_NULL) abort_on_errors_of(comm);
    return Communicator(std::make_shared<Handle>(comm, max_message));
}

Communicator Communicator::of_fortran(int number) {
    MPI_Comm comm = MPI_COMM_NULL;
    MPI_Comm_dup(MPI_Comm_f2c(static_cast<MPI_Fint>(number)), &comm);
    abort_on_errors_of(comm);
    return Communicator(std::make_shared<Handle>(comm, largest_message));
}

Communicator Communicator::of_this_rank() {
    return Communicator(std::make_shared<Handle>(duplicate_of(MPI_COMM_SELF), largest_message));
}

int Communicator::rank() const { return handle_->rank; }
int Communicator::size() const { return handle_->size; }
Traffic Communicator::traffic() const { return handle_->traffic; }
MPI_Comm native(const Communicator& communicator) { return communicator.handle().comm; }

// Adding +0 turns -0 into +0; otherwise the sign of a zero would depend on the order of ranks.
double Communicator::max(double value) const {
    return reduce(*handle_, value, MPI_DOUBLE, MPI_MAX) + 0.0;
}
double Communicator::min(double value) const {
    return reduce(*handle_, value, MPI_DOUBLE, MPI_MIN) + 0.0;
}
std::int64_t Communicator::max(std::int64_t value) const {
    return reduce(*handle_, value, MPI_INT64_T, MPI_MAX);
}
std::int64_t Communicator::min(std::int64_t value) const {
    return reduce(*handle_, value, MPI_INT64_T, MPI_MIN);
}
std::uint64_t Communicator::max(std::uint64_t value) const {
    return reduce(*handle_, value, MPI_UINT64_T, MPI_MAX);
}
std::uint64_t Communicator::min(std::uint64_t value) const {
    return reduce(*handle_, value, MPI_UINT64_T, MPI_MIN);
}
std::uint64_t Communicator::sum(std::uint64_t value) const {
    return reduce(*handle_, value, MPI_UINT64_T, MPI_SUM);
}
bool Communicator::any(bool value) const { return max(std::uint64_t{value}) == 1; }
bool Communicator::all(bool value) const { return min(std::uint64_t{value}) == 1; }

void Communicator::sum(std::span<std::uint64_t> values) const {
    const std::size_t limit = std::max<std::size_t>(1,
                                                    handle_->max_message / sizeof(std::uint64_t));
    for_pieces(values, limit, [this](std::span<std::uint64_t> piece) {
        ++handle_->traffic.collectives;
        if (handle_->is_alone()) return;
        MPI_Allreduce(MPI_IN_PLACE, piece.data(), static_cast<int>(piece.size()), MPI_UINT64_T,
                      MPI_SUM, handle_->comm);
    });
}

void Communicator::sum(ExactSum& value) const {
    // Limbs of 32 bits leave room for the carries of 2^32 ranks.
    constexpr std::uint64_t limb = 0xffffffff;
    const std::uint64_t own_low = value.low_word(), own_high = value.high_word();
    std::array<std::uint64_t, 4> limbs = {own_low & limb, own_low >> 32, own_high & limb,
                                          own_high >> 32};
    sum(limbs);
    for (std::size_t k = 0; k < 3; ++k) limbs[k + 1] += limbs[k] >> 32;
    const std::uint64_t low = (limbs[0] & limb) | (limbs[1] << 32);
    const std::uint64_t high = (limbs[2] & limb) | (limbs[3] << 32);
    // The sum contains this rank's share already, so only the share of other ranks is added.
    value.add_words(low - own_low, high - own_high - (low < own_low ? 1 : 0));
}

std::uint64_t Communicator::sum_before(std::uint64_t value) const {
    ++handle_->traffic.collectives;
    if (handle_->is_alone()) return 0;
    std::uint64_t result = 0; // on rank 0 MPI does not set the result
    MPI_Exscan(&value, &result, 1, MPI_UINT64_T, MPI_SUM, handle_->comm);
    return rank() == 0 ? 0 : result;
}

void Communicator::barrier() const {
    ++handle_->traffic.collectives;
    if (!handle_->is_alone()) MPI_Barrier(handle_->comm);
}

void Communicator::broadcast(std::string& text, int root) const {
    std::uint64_t length = text.size();
    broadcast(length, root);
    text.resize(length);
    broadcast_bytes(std::as_writable_bytes(std::span(text)), root);
}

void Communicator::broadcast_bytes(std::span<std::byte> bytes, int root) const {
    for_pieces(bytes, handle_->max_message, [this, root](std::span<std::byte> piece) {
        ++handle_->traffic.collectives;
        if (handle_->is_alone()) return;
        MPI_Bcast(piece.data(), static_cast<int>(piece.size()), MPI_BYTE, root, handle_->comm);
    });
}

void Communicator::all_gather_bytes(std::span<const std::byte> mine,
                                    std::span<std::byte> all) const {
    ensure(mine.size() <= handle_->max_message, "a value to gather is too large");
    ensure(all.size() == mine.size() * static_cast<std::size_t>(size()),
           "a gather needs room for every rank's value");
    ++handle_->traffic.collectives;
    if (handle_->is_alone()) {
        std::copy(mine.begin(), mine.end(), all.begin());
        return;
    }
    const int length = static_cast<int>(mine.size());
    MPI_Allgather(mine.data(), length, MPI_BYTE, all.data(), length, MPI_BYTE, handle_->comm);
}

void start_send(Communicator::Handle& handle, std::span<const std::byte> bytes, int to,
                int message_tag, Requests& requests) {
    for_pieces(bytes, handle.max_message, [&](std::span<const std::byte> piece) {
        ++handle.traffic.messages;
        handle.traffic.bytes += piece.size();
        MPI_Isend(piece.data(), static_cast<int>(piece.size()), MPI_BYTE, to, message_tag,
                  handle.comm, &requests.emplace_back(MPI_REQUEST_NULL));
    });
}

void start_receive(Communicator::Handle& handle, std::span<std::byte> bytes, int from,
                   int message_tag, Requests& requests) {
    for_pieces(bytes, handle.max_message, [&](std::span<std::byte> piece) {
        MPI_Irecv(piece.data(), static_cast<int>(piece.size()), MPI_BYTE, from, message_tag,
                  handle.comm, &requests.emplace_back(MPI_REQUEST_NULL));
    });
}

void wait_for(Requests& requests) {
    if (requests.empty()) return; // MPI may not have been started
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    requests.clear();
}

} // namespace carrom
