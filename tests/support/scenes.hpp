// SPDX-License-Identifier: BSD-3-Clause
// Scenes that tests share, as plain data: ordinary gases, and all cases in which simulations of
// this kind are known to fail.
//
// Every family has a fixed seed and uses + - * / sqrt only, so a scene has the same bits on every
// machine. The small scenes can all be compared with the brute-force reference, in a second or two
// together.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene_parameters.hpp"
#include "time_stepped.hpp"

namespace carrom::test {

struct TestScene {
    std::string name; ///< unique; the family and the varied numbers
    reference::Setting setting;
    std::int64_t steps = 0;
    std::vector<InputDisc> discs; ///< ids are a permutation of 0 .. N-1, often in another order

    /// All numbers of the run are exact in binary, so any correct formula gives the same bits.
    bool is_exact = false;
    /// Infinitely many collisions in a finite time in the event-driven method (Zeno's paradox).
    bool cascades_when_event_driven = false;
    /// The number of pairs that must collide, if it is known from the construction of the scene.
    std::optional<std::uint64_t> expected_pair_collisions;
};

/// The same scene in the engine's own input type, spins included.
SceneParameters scene_of(const TestScene& scene);

/// The scene with x and y exchanged, also in the box and its effects. Its states must be those of
/// the scene, exchanged bit by bit.
TestScene transposed(const TestScene& scene);
/// The scene with lengths and speeds times 2^exponent. Its states must be scaled too, bit by bit.
TestScene scaled(const TestScene& scene, int exponent);
/// The scene with other ids and in another order. It gives other results if ids break ties.
TestScene shuffled(TestScene scene, std::uint64_t seed);

std::vector<TestScene> gases();       ///< packing 0.05 to 0.7, 0.001 to 40 diameters per step
std::vector<TestScene> still_gases(); ///< discs at rest, and one fast disc or none
std::vector<TestScene> fast_scenes(); ///< the course program's speeds, L/8r to L/4 per step
std::vector<TestScene> cradles();     ///< lines from wall to wall, touching or not, along x and y
std::vector<TestScene> chains();   ///< every disc in conflict with both neighbours, across the box
std::vector<TestScene> lattices(); ///< square lattices with many equal contact times
std::vector<TestScene> breaks();   ///< a triangle of touching discs and a cue disc
std::vector<TestScene> wall_scenes();       ///< corners, discs at walls and in the band, boxes that
                                            ///< hardly fit
std::vector<TestScene> boundary_contacts(); ///< contacts on micro-step and sync boundaries to
                                            ///< within k ulp
std::vector<TestScene> overlaps();          ///< coincident and overlapping discs
std::vector<TestScene> tiny_velocities();   ///< denormal, zero and minus zero

/// All scenes above. Most have at most 60 discs, a few have 400.
std::vector<TestScene> small_scenes();
/// Some ten scenes of about 2000 discs, to cross many cells, strips and windows.
std::vector<TestScene> large_scenes();

} // namespace carrom::test
