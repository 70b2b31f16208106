// SPDX-License-Identifier: BSD-3-Clause
// Velocities of discs whose positions are generated, or listed together with `discs.speed` or
// `discs.temperature`. They are drawn for each disc independently, then corrected for all discs
// together.
//
// "maxwell": the Maxwell distribution in two dimensions, both components normal. The speed is
// sqrt(E), E exponential of mean 1. "uniform": isotropic directions, speeds uniform in [0,
// sqrt(3)]. Both distributions have the root mean square 1. A drawn sample has a random deviation
// of its energy and a random total momentum, which would last for the whole run. So the motion of
// the centre of mass is subtracted along periodic axes, where no wall would ever stop it, and
// speeds are scaled to the energy of the scene. The sums are exact, so the number of ranks does not
// change a bit.
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

/// The velocity drawn for disc `id`, of root mean square 1.
Velocity drawn_velocity(const SceneParameters& scene, DiscId id);

/// The velocity that streams add to a disc at `place`: the sum over all regions that contain it,
/// edges included.
Velocity stream_velocity(const SceneParameters& scene, Point place);

/// Adds the velocities of streams and of the flow between sheared sides to all discs, which have
/// their positions.
void add_streams(const SceneParameters& scene, std::vector<InputDisc>& discs);

/// Gives drawn velocities per step to discs, in any distribution over the ranks. The energy of all
/// discs is N kT with `discs.temperature`, and half their mass times `discs.speed` squared
/// otherwise, both to rounding. Along periodic axes their momentum is zero to rounding; a single
/// disc keeps its momentum, because it would otherwise be at rest. Energy and momentum are
/// corrected for each group of `discs.groups` separately, with its own temperature or speed.
/// Streams are added last. **Collective.**
void give_velocities(const SceneParameters& scene, std::vector<InputDisc>& discs,
                     const Communicator& communicator, int n_threads);

} // namespace carrom
