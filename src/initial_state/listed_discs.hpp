// SPDX-License-Identifier: BSD-3-Clause
// Reads listed discs, and distributes the discs of a reader over the ranks.
//
// All ranks read a file of discs at once, each a part of its bytes. If that finds an error, rank 0
// reads the whole file again, because messages contain line numbers and ids, which only a reader of
// the whole file knows.
#pragma once

#include <cstddef>
#include <istream>
#include <vector>

#include "parallel/communicator.hpp"
#include "parallel/slabs.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// A rank reads or makes this many discs before it sends them on.
inline constexpr std::size_t discs_at_once = std::size_t{1} << 16;

/// The ids of the discs that a rank starts with.
inline Slab share_of(const SceneParameters& scene, const Communicator& communicator) {
    return slab_of_rank(communicator.rank(), scene.n_discs, communicator.size());
}

/// Sends the discs in `chunk` to the ranks whose shares of ids contain them, which append them to
/// `discs`. **Collective.**
void hand_out(const std::vector<InputDisc>& chunk, const SceneParameters& scene,
              const Communicator& communicator, std::vector<InputDisc>& discs);

/// Returns this rank's share of the discs in the scene's file, checkpoint or legacy text. `lines`
/// is the stream on rank 0, at its first disc; for a checkpoint every rank has the stream of its
/// share. If other ranks cannot open a file, rank 0 reads it alone. Problems of lines and ids
/// become an InputError on every rank. **Collective.**
std::vector<InputDisc> read_listed_discs(const SceneParameters& scene, std::istream* lines,
                                         const Communicator& communicator, int n_threads);

} // namespace carrom
