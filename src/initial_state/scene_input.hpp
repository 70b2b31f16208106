// SPDX-License-Identifier: BSD-3-Clause
// Rank 0 reads a scene's text, and the columns of a list of discs except positions and velocities,
// and sends them to the other ranks. The discs of a list are read by all ranks, each a part of them
// (listed_discs.hpp).
#pragma once

#include <istream>
#include <vector>

#include "parallel/communicator.hpp"
#include "scene/disc_columns.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Replaces the text on every rank by rank 0's text. **Collective.**
void broadcast(SceneText& text, const Communicator& ranks);

/// Returns the columns of the scene's file of discs except positions and velocities. If the file
/// cannot be read, they are incomplete, and the reader of its lines reports the reason. `following`
/// is the stream of load_places; its position is restored. **Collective.**
DiscColumns load_columns(const SceneParameters& scene, std::istream* following,
                         const Communicator& ranks);

/// Returns initial_places of the scene. On rank 0, `following` is the rest of a legacy text after
/// its header, or null if no discs follow. Opens the file of discs, if there is one. Errors become
/// an InputError on every rank. **Collective.**
std::vector<InputDisc> load_places(const SceneParameters& scene, std::istream* following,
                                   const Communicator& ranks, int n_threads = 1);

} // namespace carrom
