// SPDX-License-Identifier: BSD-3-Clause
// Records with ids 0 .. n-1 in equal shares by id: how arrays that belong to the run, not to a rank, are laid out.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
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

namespace detail {

/// Fills this rank's slab; every place must be filled once.
template <class T, class IdOf> class SlabFiller {
public:
    SlabFiller(std::uint64_t first, std::uint64_t last, const IdOf& id_of)
        : first_(first), id_of_(id_of), slab_(last - first), is_filled_(slab_.size(), false) {}

    template <class Records> void fill(const Records& records) {
        for (const T& record : records) {
            const std::uint64_t place = id_of_(record) - first_;
            ensure(place < slab_.size(), "a record's id is beyond the number of records");
            ensure(!is_filled_[place], "two records have the same id");
            is_filled_[place] = true;
            slab_[place] = record;
        }
        n_filled_ += records.size();
    }

    std::vector<T> take() {
        ensure(n_filled_ == slab_.size(), "a slab has missing records");
        return std::move(slab_);
    }

private:
    std::uint64_t first_, n_filled_ = 0;
    const IdOf& id_of_;
    std::vector<T> slab_;
    std::vector<bool> is_filled_;
};

} // namespace detail

/// Brings records in any order on any ranks into slabs: returns this rank's, ascending. `id_of(record)` gives the id;
/// each of 0 .. n-1 must occur once over all ranks (checked). Memory: twice a rank's records and its slab, on one rank
/// the slab alone. **Collective.**
template <class Records, class IdOf, Message T = typename Records::value_type>
std::vector<T> to_slabs(const Communicator& communicator, const Records& records, std::uint64_t n, const IdOf& id_of) {
    const int size = communicator.size();
    const int rank = communicator.rank();
    detail::SlabFiller<T, IdOf> filler(slab_begin(rank, n, size), slab_begin(rank + 1, n, size), id_of);
    if (size == 1) {
        filler.fill(records);
        return filler.take();
    }
    std::vector<std::size_t> counts(static_cast<std::size_t>(size), 0);
    for (const T& record : records) {
        ensure(id_of(record) < n, "a record's id is beyond the number of records");
        ++counts[static_cast<std::size_t>(slab_of(id_of(record), n, size))];
    }
    std::vector<std::vector<T>> out(counts.size());
    for (std::size_t k = 0; k < counts.size(); ++k) out[k].reserve(counts[k]);
    for (const T& record : records) out[static_cast<std::size_t>(slab_of(id_of(record), n, size))].push_back(record);
    filler.fill(send_to_owners(communicator, out).items);
    return filler.take();
}

} // namespace carrom
