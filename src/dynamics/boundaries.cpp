// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/boundaries.hpp"

#include <algorithm>
#include <numbers>

#include "core/random_numbers.hpp"

namespace carrom {

namespace {

/// The duration of a small bounce of a resting disc (`rest_times_`): at most an eighth of a period,
/// or 0 if nothing oscillates.
double rest_time_at(const Boundary& side, const ContactGuard& guard, double acceleration,
                    double sway, double period, double radius) {
    if (sway != 0)
        return std::min(guard.rest_time(std::fabs(acceleration) + std::fabs(sway), radius),
                        period / 8);
    if (side.amplitude == 0) return 0;
    const double rate = 2 * std::numbers::pi / side.period;
    const double pull = std::fabs(acceleration) + side.amplitude * (rate * rate);
    return std::min(guard.rest_time(pull, radius), side.period / 8);
}

} // namespace

Boundaries::Boundaries(const Box& box, double radius, const Effects& effects)
    : sides_(effects.boundaries), guard_(effects, radius), drag_(effects.drag),
      thermal_seed_(effects.thermal_seed), box_(box), radius_(radius),
      pull_{effects.acceleration().x, effects.acceleration().y},
      sways_{effects.acceleration().amplitude_x, effects.acceleration().amplitude_y},
      fall_(effects) {
    for (std::size_t side = 0; side < 4; ++side) {
        speeds_[side] = effects.boundaries[side].speed;
        if (effects.boundaries[side].is_periodic()) away_[side] = -sign_of(side) * never;
        oscillations_[side] = Oscillation(effects.boundaries[side], sign_of(side), pull_[side / 2],
                                          8 * 0x1p-52 * box.longest());
        rest_times_[side] = rest_time_at(sides_[side], guard_, pull_[side / 2], sways_[side / 2],
                                         effects.acceleration().period, radius);
        surfaces_[side] = SurfaceTable(effects, side);
    }
    moved_ = away_;
}

void Boundaries::begin_interval(std::int64_t n) {
    const auto time = static_cast<double>(n);
    fall_.begin_interval(time);
    for (std::size_t side = 0; side < 4; ++side) {
        moved_[side] = away_[side] + speeds_[side] * time;
        oscillations_[side].begin_interval(time);
    }
}

Extent Boundaries::extent_at(double time) const {
    Extent box = extent_of_lines(time);
    const auto move = [&](std::size_t side, double& line) {
        if (oscillations_[side].is_on()) line += oscillations_[side].at(time).place;
    };
    move(0, box.x_low);
    move(1, box.x_high);
    move(2, box.y_low);
    move(3, box.y_high);
    return box;
}

Extent Boundaries::extent_of_lines(double time) const {
    return {wall_at(0, time, radius_) - radius_, wall_at(1, time, radius_) + radius_,
            wall_at(2, time, radius_) - radius_, wall_at(3, time, radius_) + radius_};
}

Extent Boundaries::walls_between(double begin, double end) const {
    const Extent first = extent_of_lines(begin), last = extent_of_lines(end);
    // A curve deviates from its chord by at most an eighth of (end - begin)^2 times the largest
    // acceleration, which occurs at the end.
    const double eighth = std::pow((end - begin) / fall_.slowing_at(end), 2) / 8;
    // A disc departs where its centre is a radius beyond an open side, so `first` and `last` are
    // two largest radii beyond it. They are moved back to the side, where tiny discs depart. When
    // an oscillating wall hits a disc, the disc is at most as fast inwards as the wall. This limits
    // how far the disc, if it flew on, would be from the wall's highest position. If the
    // acceleration changes, a wall may speed up inwards. A disc hit by the wall then gets at most
    // as far as a wall under the largest constant acceleration.
    const auto bend = [&](std::size_t side) {
        const Oscillation& wall = oscillations_[side];
        const double pull = sways_along(side) ? 8 * largest_pull_at(side)
                                              : std::fabs(pull_at(side));
        return pull * eighth + (is_open(side) ? 2 * radius_ : 0) +
               (wall.amplitude() + wall.largest_speed() * (end - begin));
    };
    // In the frame a wall that moves in may slow down. A disc that it has hit, and that flies on as
    // if there were no wall, may then be far from it at the end. But it gets at most as far as the
    // wall would at its first velocity, because the disc was slower than the wall when they met.
    const auto led = [&](std::size_t side) { return wall_velocity(side, begin) * (end - begin); };
    return {std::max({first.x_low, last.x_low, first.x_low + led(0)}) + bend(0),
            std::min({first.x_high, last.x_high, first.x_high + led(1)}) - bend(1),
            std::max({first.y_low, last.y_low, first.y_low + led(2)}) + bend(2),
            std::min({first.y_high, last.y_high, first.y_high + led(3)}) - bend(3)};
}

/// With drag, a frame and a clock that start at `time` describe the same flight as the present
/// ones, because F(s + d) - F(s) - F'(s) d = F(d / (1 - c s)). They are used for the contact.
double Boundaries::delay_of(const Approach& approach, double time) const {
    const auto& [distance, rate, pull] = approach;
    if (drag_ == 0 || pull == 0) return fall_delay(distance, rate, pull);
    const double slowing = fall_.slowing_at(time);
    return slowing * dragged_fall_delay(distance, slowing * rate, pull, drag_);
}

double Boundaries::delay_to(const DiscState& disc, std::size_t side, const Body& body) const {
    const Approach line = approach(disc, side, body);
    if (sways_along(side)) [[unlikely]] // then no side oscillates
        return fall_.sway().contact_delay(side / 2, sign_of(side), line.distance, line.rate,
                                          line.pull, disc.tau);
    if (!oscillations_[side].is_on()) [[likely]]
        return delay_of(line, disc.tau);
    const double from_wall = sign_of(side) *
                             (velocity_of(disc, side / 2) - oscillating_velocity(side, disc.tau));
    return oscillations_[side].contact_delay(line.distance, line.rate, from_wall, disc.tau);
}

Boundaries::Meeting Boundaries::meeting(const DiscState& disc, Axis axis, const Body& body) const {
    if (disc.has_departed()) return {};
    const std::size_t low = 2 * static_cast<std::size_t>(axis);
    const double to_low = delay_to(disc, low, body), to_high = delay_to(disc, low + 1, body);
    if (to_low <= to_high) return {disc.tau + to_low, low};
    return {disc.tau + to_high, low + 1};
}

/// Accelerations away from the wall are ignored. This is safe, because without them a disc meets
/// the wall earlier.
bool Boundaries::may_meet(const DiscState& disc, double time, double margin,
                          const Body& body) const {
    if (disc.has_departed()) return false;
    const double rest = time - disc.tau, fallen_for = rest / fall_.slowing_at(disc.tau);
    for (std::size_t side = 0; side < 4; ++side) {
        auto [distance, rate, pull] = approach(disc, side, body);
        const double towards = sways_along(side) ? -largest_pull_at(side) : std::min(pull, 0.0);
        const bool oscillates = oscillations_[side].is_on();
        // Use the distance to the innermost position that the wall can reach.
        if (oscillates) [[unlikely]] {
            distance -= oscillations_[side].amplitude();
            rate = std::min(rate, 0.0);
        }
        if (!(distance + (rate * rest + fall_.fallen(towards, fallen_for)) > margin) &&
            (rate < 0 || towards < 0 || oscillates))
            return true;
    }
    return false;
}

Loss Boundaries::bounce(DiscState& disc, Axis axis, double time, const Body& body, const Body& then,
                        double* spin) const {
    const std::size_t side = meeting(disc, axis, body).side;
    const double since = since_collision(disc, time);
    disc.x = disc.x_at(time);
    disc.y = disc.y_at(time);
    disc.tau = time;
    if (is_open(side)) return depart(disc, side, time, then, spin), Loss{};
    const Loss loss = rebound(disc, side, since, time, then, spin);
    disc.wall_collisions += 1;
    disc.has_collided = 1;
    return loss;
}

void Boundaries::depart(DiscState& disc, std::size_t side, double time, const Body& body,
                        double* spin) const {
    if (spin) *spin = 0;
    fall_.restart(disc, time);
    (side / 2 == 0 ? disc.x : disc.y) = departure(side, body);
    disc.depart();
    disc.wall_collisions += 1;
}

void Boundaries::reverse(DiscState& disc, Axis axis, const Body& body, double* spin) const {
    const std::size_t low = 2 * static_cast<std::size_t>(axis);
    const std::size_t side = velocity_of(disc, low / 2) < 0 ? low : low + 1;
    rebound(disc, side, never, 0, body, spin);
}

/// The acceleration that presses a disc at rest against the side. If it changes in time, this is
/// the larger of its values at `time` and at the end of a small bounce (`rest_times_`).
double Boundaries::pressure_at(std::size_t side, double time) const {
    const double sign = sign_of(side), steady = -sign * pull_at(side);
    if (!sways_along(side)) [[likely]]
        return steady;
    const auto swaying = [&](double at) {
        return -sign * fall_.sway().at(side / 2, at).acceleration;
    };
    return steady + std::max(swaying(time), swaying(time + rest_times_[side]));
}

Loss Boundaries::rebound(DiscState& disc, std::size_t side, double since, double time,
                         const Body& body, double* spin) const {
    double& normal = side / 2 == 0 ? disc.vx : disc.vy;
    double& along = side / 2 == 0 ? disc.vy : disc.vx;
    const bool oscillates = oscillations_[side].is_on();
    const double sign = sign_of(side),
                 wall = oscillates ? oscillating_velocity(side, time) : wall_velocity(side, time);
    const auto& [radius, mass, outwards] = body;
    const auto& [restitution, rubbing] = surfaces_[side].of(disc.id);
    // A disc that grows bounces as if the wall moved inwards at the speed `outwards`.
    const double closing = std::fabs(sign * (wall - normal) + outwards);
    const bool is_guarded = guard_.holds_at_wall(since, closing, radius);
    double away = outwards + (is_guarded ? 1 : restitution) * closing;
    if (sides_[side].kind == BoundaryKind::thermal) {
        // The normal velocity v of discs that leave a wall of temperature T has the probability
        // density v / T exp(-v^2 / (2 T)) for a mass of 1; the other component is normally
        // distributed. All images of a disc draw the same numbers.
        const std::uint64_t n_before = disc.wall_collisions;
        DiscRandom random(thermal_seed_, Purpose::thermal_wall, disc.id,
                          4 * n_before + drawn_side(side));
        const double temperature = sides_[side].temperature / mass;
        away = std::sqrt(2 * temperature * random_exponential(random)) / fall_.slowing_at(time);
        const double speed = std::sqrt(2 * temperature * random_exponential(random));
        along = (speed * random_direction(random).x) / fall_.slowing_at(time) +
                surface_velocity(side, time);
    }
    // A disc that will fall back leaves fast enough to stay away for the duration of a contact,
    // because a disc at rest would otherwise bounce for ever.
    const double pull = oscillates ? oscillations_[side].pressure_at(time, time + rest_times_[side])
                                   : pressure_at(side, time);
    if (pull > 0)
        away = std::max(away, guard_.least_departure(pull, radius) / fall_.slowing_at(time));
    const double before = normal;
    normal = wall + sign * away;
    if (rubbing.acts()) [[unlikely]] {
        const double t = sign_along(side);
        along += t * rubbing.rub(t * (along - surface_velocity(side, time)),
                                 std::fabs(normal - before), {spin, radius});
    }
    return guard_.loss(0.5 * mass * (1 - restitution * restitution) * (closing * closing),
                       closing * closing, is_guarded);
}

} // namespace carrom
