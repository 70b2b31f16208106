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

/// Sums over a state, with the same bits for any number of ranks and threads. Lengths and energies
/// are in the scene's units, times in steps; masses are 1 unless the scene gives them.
struct Totals {
    std::uint64_t n_discs = 0;
    /// Since the scene's start; a disc that meets two walls in a corner counts once
    std::uint64_t wall_collisions = 0;
    std::uint64_t pair_collisions = 0; ///< number of collisions of two discs
    /// Candidates that were not carried out since stepping began here; time-stepped method
    std::uint64_t rejected_candidates = 0;
    // Energy that restitution has taken in the event-driven method since stepping began here.
    // Collisions within the contact time took nothing and are counted in `guarded_collisions`.
    double energy_taken = 0;
    std::uint64_t guarded_collisions = 0; ///< number of such collisions, without contacts at rest
    double energy_spared = 0;             ///< the energy that guarded collisions would have taken
    std::uint64_t overlapping_pairs = 0;  ///< pairs that now overlap by more than the tolerance
    /// Depth of the deepest overlap; 2 r if two discs are in one place
    double deepest_overlap = 0;
    std::uint64_t touching_pairs = 0; ///< pairs that are now within the tolerance of contact
    /// Touching pairs for which only rounding decides whether they approach
    std::uint64_t sliding_pairs = 0;
    std::uint64_t chained_discs = 0; ///< discs that touch at least two others
    double kinetic_energy = 0;       ///< kinetic energy of translation, without rotation
    double rotational_energy = 0;    ///< energy of rotation, of rough discs
    /// Of positions; under gravity it is 0 at the walls towards which it pulled at the start
    double potential_energy = 0;
    double momentum_x = 0, momentum_y = 0;
    std::array<std::uint64_t, 4> departed{}; ///< discs that left through an open side: left, right,
                                             ///< bottom, top
    StateHash hash;

    double other_energy() const { return rotational_energy + potential_energy; }
    double energy() const { return kinetic_energy + rotational_energy + potential_energy; }
};

} // namespace carrom
