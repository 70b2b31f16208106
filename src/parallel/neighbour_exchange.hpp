// SPDX-License-Identifier: BSD-3-Clause
// Exchanges data with a few known ranks: halos, migrating discs, and messages about collisions
// between discs of neighbouring strips.
//
// Both sides know that they are neighbours, but the receiver does not know the amount of data. The
// first few kilobytes are sent together with the size in one message, whose receive is posted in
// advance. The rest follows in further messages, without a copy to a buffer. So a tiny exchange
// costs one short message per neighbour and no probing, and ranks that are not neighbours do not
// wait for each other.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "core/errors.hpp"
#include "parallel/communicator.hpp"
#include "parallel/received.hpp"

namespace carrom {

/// An object keeps its buffers from one exchange to the next. It has its own message tag, because a
/// rank may already use another object while its neighbour still uses this one.
class NeighbourExchange {
public:
    /// Sends nothing, but all ranks must construct their exchanges in the same order.
    explicit NeighbourExchange(const Communicator& communicator);
    ~NeighbourExchange();
    NeighbourExchange(NeighbourExchange&&) noexcept;
    NeighbourExchange& operator=(NeighbourExchange&&) noexcept;

    /// Sends out[k] to neighbours[k], and replaces `in` by the items that they send, grouped in the
    /// order of `neighbours`. `neighbours` lists ranks, each once, in any order; it may be empty
    /// and may change from call to call. Items from a rank to itself are copied, without a message.
    /// If rank a lists b, b must list a in the same call. **Collective**: ranks without neighbours
    /// take part, too, at no cost.
    template <Message T>
    void exchange(std::span<const int> neighbours, const std::vector<std::vector<T>>& out,
                  Received<T>& in) {
        in.items.clear();
        in.offsets = append(neighbours, out, in.items);
    }

    /// Like exchange, but appends the arriving items to `values`, which saves a copy. Returns where
    /// each neighbour's items begin among the appended ones, and their total. **Collective.**
    template <class Items, class Values>
    std::vector<std::size_t> append(std::span<const int> neighbours, const std::vector<Items>& out,
                                    Values& values) {
        using T = typename Values::value_type;
        static_assert(Message<T> && std::is_same_v<typename Items::value_type, T>);
        ensure(out.size() == neighbours.size(),
               "a neighbour exchange needs one list of items per neighbour");
        clear_parcels();
        for (const Items& items : out) add_parcel(std::as_bytes(std::span(items)));
        begin_parcels(neighbours);
        std::vector<std::size_t> offsets;
        for (const std::size_t offset : receive_sizes()) {
            ensure(offset % sizeof(T) == 0, "neighbours disagree on what they exchange");
            offsets.push_back(offset / sizeof(T));
        }
        const std::size_t n_before = values.size();
        values.resize(n_before + offsets.back());
        receive_parcels(std::as_writable_bytes(std::span(values).subspan(n_before)));
        return offsets;
    }

private:
    void clear_parcels();
    void add_parcel(std::span<const std::byte> bytes);
    void begin_parcels(std::span<const int> neighbours);
    std::span<const std::size_t> receive_sizes();
    void receive_parcels(std::span<std::byte> all);

    struct State;
    std::unique_ptr<State> state_;
};

} // namespace carrom
