// SPDX-License-Identifier: BSD-3-Clause
// What a run reports of its state and of the work that led there.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/state_hash.hpp"

namespace carrom {

/// What is known of a state; order-free, so the same bits for every machine shape. Energies in the
/// scene's units.
struct Totals {
    std::uint64_t n_discs = 0;
    std::uint64_t wall_collisions = 0;
    std::uint64_t pair_collisions = 0;     ///< pairs, not discs
    std::uint64_t rejected_candidates = 0; ///< since this process started stepping
    std::uint64_t overlapping_pairs = 0;   ///< now, deeper than the tolerance
    double deepest_overlap = 0;            ///< of these; 2 r where two discs are in one place
    std::uint64_t touching_pairs = 0;      ///< now, within the tolerance of contact
    std::uint64_t sliding_pairs = 0;       ///< of these: rounding decides whether they approach
    std::uint64_t chained_discs = 0;       ///< discs that touch two others or more
    double kinetic_energy = 0;             ///< of motion, not of spin
    double rotational_energy = 0;          ///< of rough discs
    double potential_energy = 0; ///< under gravity, above the walls that it pulls to at the start
    double momentum_x = 0, momentum_y = 0;
    std::array<std::uint64_t, 4>
        departed{}; ///< discs that have left, by the side they left through
    StateHash hash;
};

/// How the run got on in the event-driven method; depends on the machine shape. Zero in the
/// time-stepped method.
struct RollbackCounts {
    std::uint64_t windows = 0, windows_redone = 0; ///< redone: in some block at least, on any rank
    std::uint64_t blocks = 0,
                  blocks_redone = 0; ///< block runs on all ranks, first and repeated
};

/// Seconds this rank has spent, by phase, in the order they are reported.
using PhaseSeconds = std::vector<std::pair<std::string, double>>;

} // namespace carrom
