// SPDX-License-Identifier: BSD-3-Clause
// Velocities of generated discs: pure functions of the scene and the disc's id.
//
// "uniform": direction isotropic, speed uniform in [0, sqrt(3) v], where v = discs.speed is its
// root mean square. "maxwell": the Maxwell distribution in two dimensions, both components normal;
// speed = v sqrt(E), E exponential of mean 1, which makes the root mean square v. Nothing is
// rescaled by a measured sum: a sample's own energy and momentum scatter about their means as those
// of independent discs do.
#pragma once

#include "core/disc.hpp"
#include "lattices/lattice.hpp"
#include "scene/scene.hpp"

namespace carrom {

struct Velocity {
    double x = 0, y = 0;

    friend bool operator==(const Velocity&, const Velocity&) = default;
};

/// The velocity per step that `scene` gives to disc `id`, streams not counted.
Velocity generated_velocity(const Scene& scene, DiscId id);

/// What the streams add to a disc at `place`: the sum over all regions that hold it (edges
/// included).
Velocity stream_velocity(const Scene& scene, Point place);

} // namespace carrom
