// SPDX-License-Identifier: BSD-3-Clause
// What rank 0 reads of a scene's files, and how the other ranks get it.
#pragma once

#include <istream>
#include <vector>

#include "parallel/communicator.hpp"
#include "scene/disc_columns.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene.hpp"

namespace carrom {

/// Replaces the text on every rank by that of rank 0. **Collective.**
void broadcast(SceneText& text, const Communicator& ranks);

/// The columns of the scene's file of discs beyond places and velocities. They are not whole where
/// the file cannot be read: the reader of its lines reports why. `following` as below; it is left
/// where it was. **Collective.**
DiscColumns load_columns(const Scene& scene, std::istream* following, const Communicator& ranks);

/// The discs that a scene starts with. `following` is on rank 0 the stream of a legacy text behind
/// its header; null where no discs follow. A file of discs is opened here. Throws InputError on
/// every rank. **Collective.**
std::vector<InputDisc> load_discs(const Scene& scene, std::istream* following,
                                  const Communicator& ranks);

} // namespace carrom
