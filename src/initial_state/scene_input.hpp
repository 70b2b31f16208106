// SPDX-License-Identifier: BSD-3-Clause
// Rank 0 reads a scene's text and the columns of a list of discs beyond positions and velocities,
// and sends them to the other ranks. Each rank reads its part of the discs in a list
// (listed_discs.hpp).
#pragma once

#include <istream>
#include <vector>

#include "parallel/communicator.hpp"
#include "scene/disc_columns.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Replaces the text on every rank by that of rank 0. **Collective.**
void broadcast(SceneText& text, const Communicator& ranks);

/// The columns of the scene's file of discs beyond positions and velocities. They are incomplete if
/// the file cannot be read; the reader of its lines reports the reason. `following`: see
/// load_places; its position does not change. **Collective.**
DiscColumns load_columns(const SceneParameters& scene, std::istream* following,
                         const Communicator& ranks);

/// Returns initial_places of the scene. `following` is on rank 0 the rest of a legacy text after
/// its header, or null if no discs follow. Opens the file of discs, if there is one. Throws
/// InputError on every rank. **Collective.**
std::vector<InputDisc> load_places(const SceneParameters& scene, std::istream* following,
                                   const Communicator& ranks, int n_threads = 1);

} // namespace carrom
