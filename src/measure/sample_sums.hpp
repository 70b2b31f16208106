// SPDX-License-Identifier: BSD-3-Clause
// What a sampler has added up so far, and how a checkpoint keeps it: whole numbers in one order.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace carrom {

/// Bits of `quantities` whose sums are in a checkpoint only where they are asked for.
inline constexpr std::uint64_t thermo_bit = 64, psi6_bit = 128, structure_factor_bit = 256,
                               diffusion_bit = 512;

/// Sums over all samples so far, of all ranks together. Plain numbers: what a checkpoint keeps.
struct SampleSums {
    // What was asked for; sums of other keys are of no use.
    std::uint64_t quantities = 0;
    std::int64_t every_steps = 0, wanted_from = 0;
    double largest_distance = 0, largest_velocity = 0;

    std::int64_t first_step = 0, last_step = -1; ///< of the samples
    double speed_scale = 0;                      ///< that the unit of impulses was chosen by
    std::uint64_t n_samples = 0, n_discs = 0;    ///< n_discs: over all samples
    std::vector<std::uint64_t> pairs, vx, vy, speeds, x,
        y; ///< pairs: all bins of the first kind (pair_distances.hpp), then of the second ...
    std::vector<double> ideal_pairs; ///< likewise, what discs without size would have
    double area = 0;                 ///< of the box, over all samples
    std::array<std::uint64_t, 4> wall_collisions{};
    std::vector<double> impulses;              ///< of each interval: of the four sides
    std::vector<double> displacements;         ///< of each sample: its mean square along x, along y
    std::vector<std::uint64_t> pending;        ///< impulses and collisions since the last sample
    double virial_bound = 0;                   ///< the unit of the virial
    std::vector<double> pressures;             ///< of each interval: xx, xy, yy, kT and N kT / A
    std::vector<std::uint64_t> pending_virial; ///< since the last sample
    std::vector<double> thermo; ///< of each sample: energy, kT, discs, collisions of pairs
    std::vector<double> psi6;   ///< of each sample: sums of real and imaginary part and modulus,
                                ///< discs of 5, 6, 7 neighbours, discs
    std::vector<std::uint64_t> neighbours, moduli, psi6_pairs; ///< as HexaticSums has them
    std::vector<double> psi6_products;                         ///< likewise
    double largest_wavenumber = 0;
    std::vector<double> structure_factor; ///< of each wave vector, over all samples
    std::int64_t correlation_steps = 0;
    std::vector<double> flights;     ///< of each time in each window: mean squares of displacements
                                     ///< along x, along y, and the mean product of velocities
    std::vector<double> last_motion; ///< at the last sample: the sum of m v v, N and A
};

std::vector<std::int64_t> packed(const SampleSums& sums);
/// Nothing where the words are not such sums.
std::optional<SampleSums> unpacked(std::span<const std::int64_t> words);

} // namespace carrom
