// SPDX-License-Identifier: BSD-3-Clause
// Reads listed discs, and distributes the discs of a reader over the ranks.
//
// All ranks read a file of discs together, each a part of its bytes. If a rank finds an error, rank
// 0 reads the whole file again, because the message contains line numbers and ids, which are only
// known after all previous lines have been read.
#pragma once

#include <cstddef>
#include <istream>
#include <vector>

#include "parallel/communicator.hpp"
#include "parallel/slabs.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Number of discs that a rank reads or makes before it sends them to other ranks.
inline constexpr std::size_t discs_at_once = std::size_t{1} << 16;

/// This rank's range of ids. The ranges of all ranks are about equally long and in order of rank.
inline Slab share_of(const SceneParameters& scene, const Communicator& communicator) {
    return slab_of_rank(communicator.rank(), scene.n_discs, communicator.size());
}

/// Sends each disc of `chunk` to the rank whose share of ids contains it; that rank appends it to
/// `discs`. **Collective.**
void hand_out(const std::vector<InputDisc>& chunk, const SceneParameters& scene,
              const Communicator& communicator, std::vector<InputDisc>& discs);

/// Returns this rank's share of the discs in the scene's file, checkpoint or legacy text. `lines`
/// is rank 0's stream, at its first disc; for a checkpoint every rank has a stream of its share. If
/// another rank cannot open a file, rank 0 reads it alone. Errors in lines and ids become an
/// InputError on every rank. **Collective.**
std::vector<InputDisc> read_listed_discs(const SceneParameters& scene, std::istream* lines,
                                         const Communicator& communicator, int n_threads);

} // namespace carrom
