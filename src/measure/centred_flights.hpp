// SPDX-License-Identifier: BSD-3-Clause
// Displacements of discs since an earlier time, and their velocities at that time and now, relative
// to the centre of mass.
//
// If nothing stops the discs' common velocity V along a periodic axis, it adds V^2 t^2 to mean
// square displacements and V^2 to mean products of velocities. This motion is not diffusion and
// depends on the frame, so it is subtracted from each disc. It is not subtracted from a single
// disc, which would then be at rest, nor from discs that give momentum to fixed bodies, walls or a
// thermostat, because the centre of mass of N such discs diffuses with D / N.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// One disc's displacement `way`, its velocities at the start of the displacement and now, and its
/// mass.
struct Flight {
    std::array<double, 2> way{}, first_velocity{}, velocity{};
    double mass = 1;
};

/// Upper bounds of the absolute values of the components of `way` and of both velocities. They must
/// be the same on all ranks.
struct FlightBounds {
    double way = 0, velocity = 0;
};

/// Whether the common motion of all `n_discs` discs is subtracted, along x and along y.
std::array<bool, 2> is_centred(const SceneParameters& scene, double n_discs);

/// Mean squares of displacements along x and y, and the mean scalar product of first and present
/// velocities, over all ranks' flights. The sums are exact. **Collective.**
std::array<double, 3> mean_flights(std::vector<Flight>& flights, const FlightBounds& bounds,
                                   const SceneParameters& scene, const Communicator& ranks);

} // namespace carrom
