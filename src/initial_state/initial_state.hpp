// SPDX-License-Identifier: BSD-3-Clause
// The discs that a scene begins with, in any distribution over the ranks: generated, or read from
// the scene's list or file.
#pragma once

#include <istream>
#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Positions of discs on a lattice or at random, by the scene's generator, without velocities.
/// **Collective.**
std::vector<InputDisc> generated_places(const SceneParameters& scene,
                                        const Communicator& communicator, int n_threads);

/// The first part of initial_state, which ends before give_first_velocities. **Collective.**
std::vector<InputDisc> initial_places(const SceneParameters& scene, std::istream* lines,
                                      const Communicator& communicator, int n_threads);

/// Draws velocities and adds streams, or reverses listed velocities, as in `scene`. **Collective.**
void give_first_velocities(const SceneParameters& scene, std::vector<InputDisc>& discs,
                           const Communicator& communicator, int n_threads);

/// Throws InputError on every rank if discs overlap fixed bodies; names up to five of each rank.
/// **Collective.**
void refuse_in_fixed_bodies(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                            const Communicator& communicator);

/// Returns each disc of the scene on one rank: random discs, and lattices around fixed bodies, by
/// parts of the box, all others by ranges of ids. simulation/first_discs.hpp makes compressed
/// starts and groups, because they need engines. `lines` is the stream of read_listed_discs, or
/// null if discs are not read from lines. Wrong lines become an InputError on every rank.
/// Generators give the same discs for any number of ranks. **Collective.**
std::vector<InputDisc> initial_state(const SceneParameters& scene, std::istream* lines,
                                     const Communicator& communicator, int n_threads = 1);

} // namespace carrom
