// SPDX-License-Identifier: BSD-3-Clause
// Records with ids 0 .. n-1 in equal shares by id: how arrays that belong to the run, not to a rank, are laid out.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "carrom/core/errors.hpp"
#include "carrom/parallel/communicator.hpp"
#include "carrom/parallel/exchange.hpp"

namespace carrom {

/// The first id of a rank's slab; that of rank `size` is n. Slabs differ by at most one record, larger ones first.
inline std::uint64_t slab_begin(int rank, std::uint64_t n, int size) {
    const auto r = static_cast<std::uint64_t>(rank), p = static_cast<std::uint64_t>(size);
    return r * (n / p) + std::min(r, n % p);
}

/// The rank whose slab holds `id` < n.
inline int slab_of(std::uint64_t id, std::uint64_t n, int size) {
    const auto p = static_cast<std::uint64_t>(size);
    const std::uint64_t share = n / p, n_larger = n % p;
    const std::uint64_t in_larger = n_larger * (share + 1);
    return static_cast<int>(id < in_larger ? id / (share + 1) : n_larger + (id - in_larger) / share);
}

/// A rank's slab: its records in the order of their ids, without having been moved into that order.
template <Message T> class Slab {
public:
    Slab(Slab&&) = default; // a copy would look into the original
    std::size_t size() const { return places_.size(); }
    const T& operator[](std::size_t i) const { return records_[places_[i]]; }

private:
    Slab() = default;

    template <class IdOf, Message U>
    friend Slab<U> to_slabs(const Communicator& communicator, std::span<const U> records, std::uint64_t n, const IdOf& id_of);

    static constexpr std::uint32_t nowhere = 0xffffffff;

    /// Looks up where each id from `first` on is; every one must be there once.
    template <class IdOf> void order(std::uint64_t first, std::uint64_t last, const IdOf& id_of) {
        ensure(records_.size() == last - first && records_.size() < nowhere, "a slab has missing or surplus records");
        places_.assign(records_.size(), nowhere);
        for (std::size_t place = 0; place < records_.size(); ++place) {
            const std::uint64_t i = id_of(records_[place]) - first;
            ensure(i < places_.size(), "a record's id is beyond the number of records");
            ensure(places_[i] == nowhere, "two records have the same id");
            places_[i] = static_cast<std::uint32_t>(place);
        }
    }

    std::vector<T> received_;
    std::span<const T> records_; ///< what was received, or on one rank what was given
    std::vector<std::uint32_t> places_;
};

/// Brings records in any order on any ranks into slabs: returns this rank's. `id_of(record)` gives the id; each of
/// 0 .. n-1 must occur once over all ranks (checked). On one rank `records` must outlive the slab. Memory: twice a
/// rank's records, on one rank 4 bytes a record. **Collective.**
template <class IdOf, Message T>
Slab<T> to_slabs(const Communicator& communicator, std::span<const T> records, std::uint64_t n, const IdOf& id_of) {
    const int size = communicator.size(), rank = communicator.rank();
    Slab<T> slab;
    slab.records_ = records;
    if (size > 1) {
        std::vector<std::size_t> counts(static_cast<std::size_t>(size), 0);
        for (const T& record : records) {
            ensure(id_of(record) < n, "a record's id is beyond the number of records");
            ++counts[static_cast<std::size_t>(slab_of(id_of(record), n, size))];
        }
        std::vector<std::vector<T>> out(counts.size());
        for (std::size_t k = 0; k < counts.size(); ++k) out[k].reserve(counts[k]);
        for (const T& record : records) out[static_cast<std::size_t>(slab_of(id_of(record), n, size))].push_back(record);
        slab.received_ = std::move(send_to_owners(communicator, out).items);
        slab.records_ = slab.received_;
    }
    slab.order(slab_begin(rank, n, size), slab_begin(rank + 1, n, size), id_of);
    return slab;
}

} // namespace carrom
