// SPDX-License-Identifier: BSD-3-Clause
// Reads listed discs, and spreads discs of a reader over the ranks.
//
// A file of discs is read by all ranks at once, each a part of its bytes. Only if that finds a
// fault does rank 0 read the file alone, because it then knows the numbers of lines and all ids,
// which messages name.
#pragma once

#include <cstddef>
#include <istream>
#include <vector>

#include "parallel/communicator.hpp"
#include "parallel/slabs.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// A rank reads or makes so many discs before it hands them out.
inline constexpr std::size_t discs_at_once = std::size_t{1} << 16;

/// The ids whose discs a rank begins with.
inline Slab share_of(const SceneParameters& scene, const Communicator& communicator) {
    return slab_of_rank(communicator.rank(), scene.n_discs, communicator.size());
}

/// Sends the ranks' chunks to the ranks whose shares of ids hold the discs, which append them to
/// `discs`. **Collective.**
void hand_out(const std::vector<InputDisc>& chunk, const SceneParameters& scene,
              const Communicator& communicator, std::vector<InputDisc>& discs);

/// The rank's share of the discs in the scene's file, checkpoint or legacy text. `lines` is their
/// stream on rank 0, which stands at the first disc; of a checkpoint it is that of the rank's share
/// on others. What other ranks cannot open is read through rank 0 alone. Problems of lines and ids
/// become an InputError on every rank. **Collective.**
std::vector<InputDisc> read_listed_discs(const SceneParameters& scene, std::istream* lines,
                                         const Communicator& communicator, int n_threads);

} // namespace carrom
