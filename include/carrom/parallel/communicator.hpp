// SPDX-License-Identifier: BSD-3-Clause
// The ranks of a run and the few ways they talk: the only module that calls MPI.
//
// Values are sent as bytes, so they must be trivially copyable; all ranks run the same program. Messages of any size
// are split below MPI's 2^31 limit. A Communicator duplicates what it is given: tags of two owners never meet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace carrom {

template <class T> concept Message = std::is_trivially_copyable_v<T>;

class Communicator {
public:
    /// All ranks of the run. **Collective.** Needs a live `Mpi`.
    static Communicator world();

    int rank() const;
    int size() const;
    bool is_root() const { return rank() == 0; }

    /// Reductions over all ranks; every rank gets the result. Order-free by construction. **Collective.**
    double max(double value) const;
    double min(double value) const;
    std::int64_t max(std::int64_t value) const;
    std::uint64_t max(std::uint64_t value) const;
    std::uint64_t sum(std::uint64_t value) const; ///< wraps
    void sum(std::span<std::uint64_t> values) const; ///< element-wise, in place, wraps
    bool any(bool value) const;
    bool all(bool value) const;
};

} // namespace carrom
