// SPDX-License-Identifier: BSD-3-Clause
// Velocities of discs whose places are generated, or listed beside `discs.speed` or
// `discs.temperature`: drawn for each disc alone, then corrected for all discs together.
//
// "maxwell": the Maxwell distribution in two dimensions, both components normal. The speed is
// sqrt(E), E exponential of mean 1. "uniform": isotropic directions, speeds uniform in
// [0, sqrt(3)]. Either has the root mean square 1. A drawn sample has another energy and a total
// momentum by chance, and both stay for the whole run. So the motion of the centre of mass is
// subtracted along periodic axes, where no wall would ever stop it, and speeds are scaled to the
// energy that the scene asks for. The sums are exact, so the number of ranks does not change a bit.
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

/// The velocity that streams add to a disc at `place`: the sum over all regions that
/// hold it, edges included.
Velocity stream_velocity(const SceneParameters& scene, Point place);

/// Adds streams, and the flow of sheared sides, to all discs, which have their places.
void add_streams(const SceneParameters& scene, std::vector<InputDisc>& discs);

/// Gives drawn velocities per step to discs, in any distribution over the
/// ranks. The energy of all discs is N kT with `discs.temperature`, and half their mass times
/// `discs.speed` squared otherwise, both to rounding. Along periodic axes their momentum is zero to
/// rounding; a disc that is alone keeps it, because it would be at rest. Both hold for each group
/// of `discs.groups` by itself, with its own temperature or speed. Streams are added last.
/// **Collective.**
void give_velocities(const SceneParameters& scene, std::vector<InputDisc>& discs,
                     const Communicator& communicator);

} // namespace carrom
