// SPDX-License-Identifier: BSD-3-Clause
// A fingerprint of a whole state. It does not depend on the order of the discs, nor on the ranks
// that own them.
//
// The record of each disc (id, position, velocity, local time, counters; -0 counts as +0) is hashed
// with XXH3-128. The hashes are added, so ranks and threads may add their shares in any order.
// Cost: about 10 ns per disc.
#pragma once

#include <span>

#include <carrom/totals.hpp>

#include "core/disc_state.hpp"
#include "core/side_columns.hpp"

namespace carrom {

StateHash hash_of(const DiscState& disc);
StateHash hash_of(std::span<const DiscState> discs);

/// The term that a disc's number in a side column adds to the hash of the state.
StateHash hash_of(SideColumn column, DiscId id, double number);

#ifdef _OPENMP
// Lets OpenMP reduce hashes over threads, as it does with numbers.
#pragma omp declare reduction(+ : StateHash : omp_out += omp_in)
#endif

} // namespace carrom
