// SPDX-License-Identifier: BSD-3-Clause
// Velocities of discs whose positions are generated, or listed together with `discs.speed` or
// `discs.temperature`. They are drawn for each disc independently, then corrected for all discs
// together.
//
// "maxwell": the Maxwell distribution in two dimensions; both components are normal. The speed is
// sqrt(E), where E is exponentially distributed with mean 1. "uniform": isotropic directions,
// speeds uniform in [0, sqrt(3)]. Both distributions have the root mean square speed 1. A drawn
// sample has a random error of its energy and a random total momentum, which would last for the
// whole run. So the centre of mass is brought to rest along periodic axes, where no wall would ever
// stop it, and speeds are scaled to the scene's energy. Sums are exact, so the bits do not depend
// on the number of ranks.
#pragma once

#include <vector>

#include "core/disc_state.hpp"
#include "lattices/lattice.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

struct Velocity {
    double x = 0, y = 0;

    friend bool operator==(const Velocity&, const Velocity&) = default;
};

/// The velocity drawn for disc `id`; the distribution has the root mean square speed 1.
Velocity drawn_velocity(const SceneParameters& scene, DiscId id);

/// The velocity that streams add to a disc at `place`: the sum over all streams whose regions,
/// edges included, contain `place`.
Velocity stream_velocity(const SceneParameters& scene, Point place);

/// Adds the velocities of streams, and of the flow between sheared sides, to all discs. Discs must
/// have their positions.
void add_streams(const SceneParameters& scene, std::vector<InputDisc>& discs);

/// Sets drawn velocities, in lengths per step; discs are in any distribution over the ranks. The
/// total energy is N kT with `discs.temperature`, and otherwise half the total mass times
/// `discs.speed` squared, up to rounding. Along periodic axes the total momentum is zero up to
/// rounding; a single disc keeps its momentum, because it would otherwise be at rest. Each group of
/// `discs.groups` is corrected separately, with its own temperature or speed. Streams are added
/// last. **Collective.**
void give_velocities(const SceneParameters& scene, std::vector<InputDisc>& discs,
                     const Communicator& communicator, int n_threads);

} // namespace carrom
