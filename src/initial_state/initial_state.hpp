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

/// Does the same as initial_state, but without give_first_velocities. **Collective.**
std::vector<InputDisc> initial_places(const SceneParameters& scene, std::istream* lines,
                                      const Communicator& communicator, int n_threads);

/// Draws velocities and adds streams, or reverses listed velocities, as set in `scene`.
/// **Collective.**
void give_first_velocities(const SceneParameters& scene, std::vector<InputDisc>& discs,
                           const Communicator& communicator, int n_threads);

/// Throws InputError on every rank if discs overlap fixed bodies. Names up to five of these discs
/// of each rank, or one if the scene has groups. **Collective.**
void refuse_in_fixed_bodies(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                            const Communicator& communicator);

/// Returns each disc of the scene on one rank. Random discs and lattices around fixed bodies are
/// distributed by position, all others by ranges of ids. Compressed starts and groups are made in
/// simulation/first_discs.hpp instead, because they need engines. `lines` is the stream of
/// read_listed_discs, or null if discs are not read from lines. Every rank throws InputError if a
/// line is wrong. Generators give the same discs for any number of ranks. **Collective.**
std::vector<InputDisc> initial_state(const SceneParameters& scene, std::istream* lines,
                                     const Communicator& communicator, int n_threads = 1);

} // namespace carrom
