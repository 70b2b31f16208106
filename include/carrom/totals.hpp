// SPDX-License-Identifier: BSD-3-Clause
// Sums over all discs of a simulation at its present step.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace carrom {

/// A fingerprint of a whole state: every disc's id, position, velocity, time and counters. It does
/// not depend on ranks, threads or the order of discs. -0 counts as +0.
struct StateHash {
    std::uint64_t low = 0, high = 0;

    /// Hashes of disjoint sets of discs add up to the hash of all.
    StateHash& operator+=(const StateHash& other) {
        low += other.low;
        high += other.high;
        return *this;
    }
    friend bool operator==(const StateHash&, const StateHash&) = default;
};

/// 32 hexadecimal digits, the high half first, as in the summary of `carrom run`.
std::string to_string(const StateHash& hash);

/// What is known of a state. The same bits for any number of ranks and threads. Lengths and
/// energies are in the scene's units, times in steps; masses are 1 unless the scene names them.
struct Totals {
    std::uint64_t n_discs = 0;
    std::uint64_t wall_collisions = 0;     ///< since the scene's start; a corner counts once
    std::uint64_t pair_collisions = 0;     ///< pairs, not discs
    std::uint64_t rejected_candidates = 0; ///< time-stepped method, since stepping began here
    // Event-driven method, since stepping began here: what restitution has taken, and collisions
    // that took nothing because one of the discs had collided within the contact time.
    double energy_taken = 0;
    std::uint64_t guarded_collisions = 0; ///< contacts at rest aside
    double energy_spared = 0;             ///< what these would have taken
    std::uint64_t overlapping_pairs = 0;  ///< now, deeper than the tolerance
    double deepest_overlap = 0;           ///< of these; 2 r where two discs are in one place
    std::uint64_t touching_pairs = 0;     ///< now, within the tolerance of contact
    std::uint64_t sliding_pairs = 0;      ///< of these: rounding decides whether they approach
    std::uint64_t chained_discs = 0;      ///< discs that touch two others or more
    double kinetic_energy = 0;            ///< of motion, not of spin
    double rotational_energy = 0;         ///< of rough discs
    double potential_energy = 0; ///< of places; under gravity above the walls that it pulls to at
                                 ///< the start
    double momentum_x = 0, momentum_y = 0;
    std::array<std::uint64_t, 4> departed{}; ///< discs that left through an open side: left, right,
                                             ///< bottom, top
    StateHash hash;

    double other_energy() const { return rotational_energy + potential_energy; }
    double energy() const { return kinetic_energy + rotational_energy + potential_energy; }
};

} // namespace carrom
