// SPDX-License-Identifier: BSD-3-Clause
// Divides records with ids 0 .. n-1 into slabs: nearly equal shares of consecutive ids, one for
// each rank. Arrays of all discs have this layout if it does not matter which ranks own the discs.
#pragma once

#include <algorithm>
#include <cstdint>

namespace carrom {

/// The first id of a rank's slab; slab `size` begins at n. Slabs differ by at most one
/// record, larger ones first.
inline std::uint64_t slab_begin(int rank, std::uint64_t n, int size) {
    const auto r = static_cast<std::uint64_t>(rank), p = static_cast<std::uint64_t>(size);
    return r * (n / p) + std::min(r, n % p);
}

/// The ids [begin, end).
struct Slab {
    std::uint64_t begin = 0, end = 0;

    std::uint64_t size() const { return end - begin; }
};
inline Slab slab_of_rank(int rank, std::uint64_t n, int size) {
    return {slab_begin(rank, n, size), slab_begin(rank + 1, n, size)};
}

/// The rank whose slab holds `id` < n.
inline int slab_of(std::uint64_t id, std::uint64_t n, int size) {
    const auto p = static_cast<std::uint64_t>(size);
    const std::uint64_t share = n / p, n_larger = n % p;
    const std::uint64_t in_larger = n_larger * (share + 1);
    return static_cast<int>(id < in_larger ? id / (share + 1)
                                           : n_larger + (id - in_larger) / share);
}

} // namespace carrom
