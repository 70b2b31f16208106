// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/velocities.hpp"

#include <cmath>
#include <numbers>

#include "core/axis.hpp"
#include "core/random_numbers.hpp"

namespace carrom {

Velocity generated_velocity(const Scene& scene, DiscId id) {
    DiscRandom random(scene.seed, Purpose::velocity, id);
    const Direction direction = random_direction(random);
    const double speed = scene.velocities == VelocityKind::maxwell
                             ? scene.speed * std::sqrt(random_exponential(random))
                             : scene.speed * (std::numbers::sqrt3 * random.uniform());
    // A box that is taller than wide has the gas of the same one lying down.
    const auto [vx, vy] = turned(longer_axis(scene.box), speed * direction.x, speed * direction.y);
    return {vx, vy};
}

Velocity stream_velocity(const Scene& scene, Point place) {
    Velocity sum;
    for (const Stream& stream : scene.streams) {
        const bool is_inside = place.x >= stream.x_low && place.x <= stream.x_high &&
                               place.y >= stream.y_low && place.y <= stream.y_high;
        if (!is_inside) continue;
        sum.x += stream.vx;
        sum.y += stream.vy;
    }
    return sum;
}

} // namespace carrom
