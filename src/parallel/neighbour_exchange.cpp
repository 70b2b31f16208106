// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/neighbour_exchange.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "core/raw_vector.hpp"
#include "parallel/handle.hpp"

namespace carrom {

namespace {

/// The head of a first message. The number of the exchange reveals two ranks that disagree about
/// being neighbours.
struct Header {
    std::uint64_t n_bytes = 0;
    std::uint64_t exchange = 0;
};

/// Slightly less than the size up to which common MPI libraries send immediately, without a
/// handshake (4096 in shared memory).
constexpr std::size_t first_message_bytes = 3968;

} // namespace

struct NeighbourExchange::State {
    explicit State(const Communicator& of_owner) : communicator(of_owner) {
        Communicator::Handle& handle = communicator.handle();
        message_tag = handle.next_tag;
        handle.next_tag = message_tag < tag::last ? message_tag + 1 : tag::first_free;
        first_capacity = std::max(std::min(first_message_bytes, handle.max_message),
                                  sizeof(Header)) -
                         sizeof(Header);
    }

    std::size_t first_size() const { return sizeof(Header) + first_capacity; }
    bool is_own(std::size_t k) const { return neighbours[k] == communicator.rank(); }
    std::byte* first_in(std::size_t k) { return firsts.data() + k * first_size(); }
    std::byte* first_out(std::size_t k) {
        return firsts.data() + (neighbours.size() + k) * first_size();
    }

    Communicator communicator;
    int message_tag = 0;
    std::size_t first_capacity = 0; ///< bytes of data in a first message
    std::uint64_t n_begun = 0;
    std::vector<int> neighbours;
    std::vector<std::span<const std::byte>> parcels;
    RawVector<std::byte> firsts; ///< buffers of the first messages: received ones, then sent ones
    std::vector<std::size_t> offsets;
    Requests receives, sends;
};

NeighbourExchange::NeighbourExchange(const Communicator& communicator)
    : state_(std::make_unique<State>(communicator)) {}
NeighbourExchange::~NeighbourExchange() = default;
NeighbourExchange::NeighbourExchange(NeighbourExchange&&) noexcept = default;
NeighbourExchange& NeighbourExchange::operator=(NeighbourExchange&&) noexcept = default;

void NeighbourExchange::clear_parcels() { state_->parcels.clear(); }

void NeighbourExchange::add_parcel(std::span<const std::byte> bytes) {
    state_->parcels.push_back(bytes);
}

void NeighbourExchange::begin_parcels(std::span<const int> neighbours) {
    State& state = *state_;
    Communicator::Handle& handle = state.communicator.handle();
    state.n_begun += 1;
    state.neighbours.assign(neighbours.begin(), neighbours.end());
    state.firsts.resize(2 * neighbours.size() * state.first_size());
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
        if (state.is_own(k)) continue;
        MPI_Irecv(state.first_in(k), static_cast<int>(state.first_size()), MPI_BYTE, neighbours[k],
                  state.message_tag, handle.comm, &state.receives.emplace_back(MPI_REQUEST_NULL));
    }
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
        if (state.is_own(k)) continue;
        const std::span<const std::byte> parcel = state.parcels[k];
        const std::span<const std::byte> head = parcel.first(
            std::min(parcel.size(), state.first_capacity));
        const Header header = {parcel.size(), state.n_begun};
        std::byte* const message = state.first_out(k);
        std::memcpy(message, &header, sizeof header);
        if (!head.empty()) std::memcpy(message + sizeof header, head.data(), head.size());
        const std::size_t length = sizeof header + head.size();
        ++handle.traffic.messages;
        handle.traffic.bytes += length;
        MPI_Isend(message, static_cast<int>(length), MPI_BYTE, neighbours[k], state.message_tag,
                  handle.comm, &state.sends.emplace_back(MPI_REQUEST_NULL));
        start_send(handle, parcel.subspan(head.size()), neighbours[k], state.message_tag,
                   state.sends);
    }
}

std::span<const std::size_t> NeighbourExchange::receive_sizes() {
    State& state = *state_;
    wait_for(state.receives);
    state.offsets.assign(1, 0);
    for (std::size_t k = 0; k < state.neighbours.size(); ++k) {
        Header header = {state.parcels[k].size(), state.n_begun};
        if (!state.is_own(k)) std::memcpy(&header, state.first_in(k), sizeof header);
        ensure(header.exchange == state.n_begun,
               "two ranks disagree on whether they are neighbours");
        state.offsets.push_back(state.offsets.back() + header.n_bytes);
    }
    return state.offsets;
}

void NeighbourExchange::receive_parcels(std::span<std::byte> all) {
    State& state = *state_;
    for (std::size_t k = 0; k < state.neighbours.size(); ++k) {
        const std::span<std::byte> parcel = all.subspan(state.offsets[k],
                                                        state.offsets[k + 1] - state.offsets[k]);
        if (state.is_own(k)) {
            if (!parcel.empty()) std::memcpy(parcel.data(), state.parcels[k].data(), parcel.size());
            continue;
        }
        const std::size_t head = std::min(parcel.size(), state.first_capacity);
        if (head > 0) std::memcpy(parcel.data(), state.first_in(k) + sizeof(Header), head);
        start_receive(state.communicator.handle(), parcel.subspan(head), state.neighbours[k],
                      state.message_tag, state.receives);
    }
    wait_for(state.receives);
    wait_for(state.sends);
}

} // namespace carrom
