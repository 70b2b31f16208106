// SPDX-License-Identifier: BSD-3-Clause
// Sums over all discs of a simulation at its present step.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace carrom {

/// A fingerprint of a whole state: of each disc's id, position and velocity, the time to which they
/// belong, and its counters. The order of discs and the numbers of ranks and threads do not affect
/// it; -0 counts as +0.
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

/// The hash as 32 hexadecimal digits, high half first, as in the summary of `carrom run`.
std::string to_string(const StateHash& hash);

/// Sums over a state, with the same bits for any number of ranks and threads. Lengths and energies
/// are in the scene's units, times in steps; masses are 1 unless the scene gives them.
struct Totals {
    std::uint64_t n_discs = 0;
    /// Wall collisions since the scene's start; hitting two walls in a corner counts once
    std::uint64_t wall_collisions = 0;
    std::uint64_t pair_collisions = 0; ///< number of collisions of two discs
    /// Collision candidates rejected since this simulation was made; 0 in event-driven runs
    std::uint64_t rejected_candidates = 0;
    // Energy lost by restitution since this simulation was made, in the event-driven method.
    // Collisions of discs that have just collided lose none; `guarded_collisions` counts these.
    double energy_taken = 0;
    std::uint64_t guarded_collisions = 0; ///< number of these collisions, without contacts at rest
    double energy_spared = 0;             ///< energy that these would otherwise have lost
    std::uint64_t overlapping_pairs = 0;  ///< pairs that now overlap by more than the tolerance
    /// Depth of the deepest overlap; the sum of both radii if two centres coincide
    double deepest_overlap = 0;
    std::uint64_t touching_pairs = 0; ///< pairs that are now within the tolerance of contact
    /// Touching pairs whose speed of approach is zero to within rounding
    std::uint64_t sliding_pairs = 0;
    std::uint64_t chained_discs = 0; ///< discs that touch at least two others
    double kinetic_energy = 0;       ///< kinetic energy of translation, without rotation
    double rotational_energy = 0;    ///< energy of rotation of rough discs
    /// Potential energy; for gravity, heights are measured from the walls' positions at step 0
    double potential_energy = 0;
    double momentum_x = 0, momentum_y = 0;
    std::array<std::uint64_t, 4> departed{}; ///< number of discs that left through each open side:
                                             ///< left, right, bottom, top
    StateHash hash;

    double other_energy() const { return rotational_energy + potential_energy; }
    double energy() const { return kinetic_energy + rotational_energy + potential_energy; }
};

} // namespace carrom
