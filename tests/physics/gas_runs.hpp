// SPDX-License-Identifier: BSD-3-Clause
// Gases in a walled box in the event-driven method, brought to equilibrium and measured.
#pragma once

#include <cstdint>

#include "averaging.hpp"
#include "scene_tools.hpp"
#include "simulation/disc_system.hpp"

namespace carrom::test {

/// n discs of radius 1 on the first places of a square lattice, with speeds of one diameter per
/// step, on rank 0.
TestScene crystal(std::size_t n, double packing, std::uint64_t seed);

/// A system of the scene in the event-driven method.
DiscSystem event_driven_system(const TestScene& scene, const Communicator& world);

/// Steps until there have been this many collisions, of pairs and with walls, since the start.
/// **Collective.**
void run_until(DiscSystem& system, double n_collisions, std::span<StepAction* const> actions = {});

/// In units of disc diameter and thermal speed sqrt(kT).
struct GasProperties {
    Estimate wall_factor;   ///< compressibility factor P L^2 / (N kT), from walls alone
    Estimate virial_factor; ///< the same factor from the virial of walls and pairs
    Estimate frequency;     ///< nu sigma / sqrt(kT / m)
    Estimate kurtosis;
};

/// Measures a gas over about `n_collisions`, after `n_early` collisions to reach equilibrium.
/// **Collective.**
GasProperties measure_gas(std::size_t n, double packing, double n_early, double n_collisions,
                          const Communicator& world);

/// The difference of two estimates in standard errors; `known` is exact.
double deviation(const Estimate& a, const Estimate& b);
double deviation(const Estimate& measured, double known);

} // namespace carrom::test
