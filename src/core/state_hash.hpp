// SPDX-License-Identifier: BSD-3-Clause
// A fingerprint of a whole state that does not depend on who holds which disc, or in which order.
//
// Each disc's record (id, position, velocity, local time, counters; -0 counts as +0) is hashed with
// XXH3-128 and the hashes are added, so ranks and threads may add their shares in any order. Cost:
// some 10 ns a disc.
#pragma once

#include <span>

#include <carrom/totals.hpp>

#include "core/disc_state.hpp"
#include "core/side_columns.hpp"

namespace carrom {

StateHash hash_of(const DiscState& disc);
StateHash hash_of(std::span<const DiscState> discs);

/// What a disc's number in a side column adds to the hash, if the run has that column.
StateHash hash_of(SideColumn column, DiscId id, double number);

#ifdef _OPENMP
// Threads add parts, as they do with numbers.
#pragma omp declare reduction(+ : StateHash : omp_out += omp_in)
#endif

} // namespace carrom
