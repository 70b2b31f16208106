// SPDX-License-Identifier: BSD-3-Clause
// Records with ids 0 .. n-1 in equal shares by id: how arrays that belong to the run, not to a rank, are laid out.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
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

/// Brings records in any order on any ranks into slabs: returns this rank's, ascending. `id_of(record)` gives the id;
/// each of 0 .. n-1 must occur once over all ranks (checked). Memory: twice a rank's records and its slab.
/// **Collective.**
template <class Records, class IdOf, Message T = typename Records::value_type>
std::vector<T> to_slabs(const Communicator& communicator, const Records& records, std::uint64_t n, const IdOf& id_of) {
    std::vector<std::vector<T>> out(static_cast<std::size_t>(communicator.size()));
    for (const T& record : records) {
        ensure(id_of(record) < n, "a record's id is beyond the number of records");
        out[static_cast<std::size_t>(slab_of(id_of(record), n, communicator.size()))].push_back(record);
    }
    const Received<T> in = send_to_owners(communicator, out);
    const std::uint64_t first = slab_begin(communicator.rank(), n, communicator.size());
    const std::uint64_t last = slab_begin(communicator.rank() + 1, n, communicator.size());
    ensure(in.items.size() == last - first, "a slab has missing or surplus records");
    std::vector<T> slab(in.items.size());
    std::vector<unsigned char> is_filled(slab.size(), 0);
    for (const T& record : in.items) {
        const std::size_t place = id_of(record) - first;
        ensure(is_filled[place] == 0, "two records have the same id");
        is_filled[place] = 1;
        slab[place] = record;
    }
    return slab;
}

} // namespace carrom
