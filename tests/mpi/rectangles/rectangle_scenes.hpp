// SPDX-License-Identifier: BSD-3-Clause
// Scenes in boxes that are longer than high, one for each kind of effect.
#pragma once

#include <array>
#include <vector>

#include "effect_runs.hpp"

namespace carrom::test {

inline constexpr Boundary periodic{BoundaryKind::periodic, 1, 0, 0};
inline constexpr std::array<Boundary, 4> all_round{periodic, periodic, periodic, periodic},
    along_x{periodic, periodic, Boundary{}, Boundary{}},
    along_y{Boundary{}, Boundary{}, periodic, periodic};

/// A gas of discs of radius 1 on a shaken lattice of columns and rows with this distance. Speeds in
/// diameters per step.
TestScene rectangle(std::size_t columns, std::size_t rows, double pitch, double speed,
                    std::uint64_t seed);

/// Discs of radius 1 in a row in a tube of this height.
TestScene tube(std::size_t n, double height, double pitch, std::uint64_t seed);

/// A scene and its method.
struct Case {
    TestScene scene;
    Method method;
};

/// Wide boxes with walls of all kinds, open and periodic sides, obstacles, species, spins, gravity
/// and drag; also tubes as wide as a disc.
std::vector<Case> cases();

} // namespace carrom::test
