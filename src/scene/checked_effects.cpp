// SPDX-License-Identifier: BSD-3-Clause
// The checks of times, effects and measurements that look at more than one number.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "dynamics/drag.hpp"
#include "dynamics/gravity.hpp"
#include "dynamics/oscillation.hpp"
#include "scene/check.hpp"
#include "scene/limits.hpp"
#include "scene/quantity.hpp"

namespace carrom {

namespace {

/// Rate times the time between syncs.
constexpr double longest_drag = 4;
/// Of a wall, in times between syncs: those are known to 2^-53 of themselves.
constexpr double smallest_period = 1e-6;
/// Of a fixed disc's radius and that of a disc, over the box: a disc touches the nearest images of
/// a body at most.
constexpr double largest_in_period = 0.99;
/// Tables that grow with time are kept in memory and in checkpoints.
constexpr std::int64_t most_samples_of_histories = 100000;

std::string side_key(std::size_t side, const char* name) {
    return fmt::format("box.{}.{}", boundary_names[side], name);
}

double steps_between_syncs(const Scene& scene) {
    return static_cast<double>(scene.sync_every) / static_cast<double>(scene.micro_steps);
}

/// What contact times may be, and why; in steps.
struct LongestContact {
    double time;
    const char* why;
};

/// The pull at an oscillating wall changes little in a contact time.
LongestContact longest_contact(const Scene& scene) {
    LongestContact longest{steps_between_syncs(scene) / 4,
                           "a quarter of the time between syncs ('time.sync_every')"};
    for (const Boundary& side : scene.effects.boundaries)
        if (side.kind == BoundaryKind::oscillating && side.period / 8 < longest.time)
            longest = {side.period / 8, "an eighth of a wall's period"};
    return longest;
}

/// Between syncs a disc is as good as touched by the sync: a contact time as long would leave no
/// dissipation at all.
void check_contact_time(const Check& check) {
    constexpr std::string_view key = "effects.contact.contact_time";
    Scene& scene = check.scene;
    const auto [longest, why] = longest_contact(scene);
    double& time = scene.effects.contact.contact_time;
    if (!lose_energy_or_fall(scene.effects)) return;
    if (!check.settings.has(key)) time = std::min(time, longest);
    if (time > longest)
        check.refuse({key}, fmt::format("'{}' must be at most {} steps, {}, not {}", key, longest,
                                        why, time));
}

/// The falling frame must not leave the box far behind: its coordinates would be coarser than the
/// box's.
void check_fall(const Check& check) {
    const Scene& scene = check.scene;
    const double time = steps_between_syncs(scene), drag = scene.effects.drag;
    if (drag * time > longest_drag) return; // a problem already
    const double fall = drag > 0 ? dragged_fall(drag, drag_clock(drag, time)) : 0.5 * time * time;
    for (const auto& [key, g] : {std::pair("effects.gravity.x", scene.effects.gravity.x),
                                 {"effects.gravity.y", scene.effects.gravity.y}}) {
        if (std::fabs(g) * fall <= 0.5 * scene.box.longest()) continue;
        const double longest = std::floor(std::sqrt(scene.box.longest() / std::fabs(g)) *
                                          static_cast<double>(scene.micro_steps));
        check.refuse({key},
                     fmt::format("'{}' = {} makes discs fall further than half the box "
                                 "from sync to sync; {}",
                                 key, g,
                                 longest >= 1
                                     ? fmt::format("time.sync_every = {} or less will do", longest)
                                     : "take more time.micro_steps"));
    }
}

void check_obstacles(const Check& check) {
    const Box box = check.scene.box;
    const double size = box.longest(), radius = check.scene.radius;
    const bool is_periodic = check.scene.effects.are_periodic();
    const double period = check.scene.effects.periods(box).shortest();
    const auto is_inside = [box](double x, double y) {
        return x >= 0 && x <= box.x && y >= 0 && y <= box.y;
    };
    check.refuse_rows("effects.obstacles.discs", [&](const Numbers& n, std::size_t) -> std::string {
        if (!is_inside(n[0], n[1]))
            return fmt::format("the centre ({}, {}) is not in the box", n[0], n[1]);
        if (!(n[2] >= 0 && n[2] <= size))
            return fmt::format("the radius must be from 0 to {}, not {}", size, n[2]);
        if (is_periodic && !(n[2] + radius <= largest_in_period * period))
            return fmt::format("the radius must be at most {:g}, not {}: with a disc's it would "
                               "reach through a periodic box and into itself",
                               largest_in_period * period - radius, n[2]);
        return {};
    });
    check.refuse_rows(
        "effects.obstacles.segments", [&](const Numbers& n, std::size_t) -> std::string {
            if (!is_inside(n[0], n[1]) || !is_inside(n[2], n[3]))
                return fmt::format("the segment from ({}, {}) to ({}, {}) has an end outside the "
                                   "box",
                                   n[0], n[1], n[2], n[3]);
            const double length = std::hypot(n[2] - n[0], n[3] - n[1]);
            if (!(length > 0x1p-30 * size))
                return fmt::format("a segment of length {}: a point is a fixed disc of radius 0",
                                   length);
            return {};
        });
}

void check_periodic_box(const Check& check) {
    const Scene& scene = check.scene;
    const Periods periods = scene.effects.periods(scene.box);
    const double period = periods.shortest();
    if (!periods.are_any() || period >= 4 * scene.radius * (1 + 1e-6)) return;
    check.refuse({side_key(periods.x == period ? 0 : 2, "kind")},
                 fmt::format("a box of side {} is too small to be periodic: up to two diameters "
                             "({}) a disc could touch another one on both sides at once",
                             period, 4 * scene.radius));
}

void check_thermal_walls(const Check& check) {
    for (std::size_t side = 0; side < boundary_names.size(); ++side) {
        const std::string key = side_key(side, "temperature");
        const double speed = std::sqrt(check.scene.effects.boundaries[side].temperature);
        if (const std::string text = speed_problem(speed, check.scene); !text.empty())
            check.refuse({key}, fmt::format("'{}': {}", key, text));
    }
}

/// Whether the discs may fit into a box of that size.
bool has_room(const Scene& scene, double width, double height) {
    const double covered = scene.packing() * scene.box.x * scene.box.y;
    const bool is_full = scene.effects.contact.kind != ContactKind::none &&
                         covered > largest_packing * width * height;
    return std::min(width, height) >= 2 * scene.radius * (1 + 1e-6) && !is_full;
}

/// Walls that move must leave room for the discs until the last step.
void check_moving_walls(const Check& check) {
    const Scene& scene = check.scene;
    const auto& boundaries = scene.effects.boundaries;
    const Extent end = extent_at(scene.effects, scene.box, static_cast<double>(scene.steps));
    const double width = end.x_high - end.x_low, height = end.y_high - end.y_low;
    const bool is_long = end.x_high > 2 * scene.box.x || end.y_high > 2 * scene.box.y;
    for (std::size_t side = 0; side < boundaries.size(); ++side) {
        if (boundaries[side].speed == 0) continue;
        if (!has_room(scene, width, height))
            check.refuse({side_key(side, "speed")},
                         fmt::format("after {} steps the box would be {} by {}: too small for its "
                                     "discs",
                                     scene.steps, width, height));
        else if (is_long)
            check.refuse({side_key(side, "speed")},
                         fmt::format("after {} steps the box would be more than twice as long as "
                                     "at the start",
                                     scene.steps));
        break;
    }
}

/// Discs that are generated lie between the lines of the walls.
bool begins_before_its_line(const Scene& scene, std::size_t side) {
    if (scene.generator == Generator::file) return false;
    const double place = oscillation_at(scene.effects.boundaries[side], 0).place;
    return (side % 2 == 0 ? place : -place) > 0x1p-52 * scene.box.longest();
}

void check_oscillating_walls(const Check& check) {
    const Scene& scene = check.scene;
    const double interval = steps_between_syncs(scene), least = smallest_period * interval;
    for (std::size_t side = 0; side < boundary_names.size(); ++side) {
        const Boundary& wall = scene.effects.boundaries[side];
        if (wall.kind != BoundaryKind::oscillating) continue;
        const std::string amplitude = side_key(side, "amplitude"), phase = side_key(side, "phase");
        if (wall.period < least)
            check.refuse({side_key(side, "period")},
                         fmt::format("'{}' must be at least {:g} steps, a millionth of the time "
                                     "between syncs ('time.sync_every'), not {}",
                                     side_key(side, "period"), least, wall.period));
        for (const double time : {0.0, static_cast<double>(scene.steps)}) {
            const Extent room = extent_of_lines(scene.effects, scene.box, time, 1);
            const double width = room.x_high - room.x_low, height = room.y_high - room.y_low;
            if (has_room(scene, width, height)) continue;
            check.refuse({amplitude}, fmt::format("'{}' = {} leaves a box of {} by {}: too small "
                                                  "for its discs",
                                                  amplitude, wall.amplitude, width, height));
            break;
        }
        if (const std::string text = speed_problem(largest_wall_speed(scene.effects), scene);
            !text.empty())
            check.refuse({amplitude}, fmt::format("'{}': {}", amplitude, text));
        if (begins_before_its_line(scene, side))
            check.refuse({phase, amplitude},
                         fmt::format("the {} wall begins inside the box, where generated discs "
                                     "may be; take another '{}', or list the discs",
                                     boundary_names[side], phase));
    }
}

/// Discs that grow must have room until the last step.
void check_growth(const Check& check) {
    const Scene& scene = check.scene;
    if (scene.effects.growth == 0) return;
    const double growth = scene.effects.growth_at(static_cast<double>(scene.steps));
    const double densest = scene.effects.species.empty() ? largest_packing : 1;
    const auto room = [&scene](double side, bool is_periodic) {
        return side / ((is_periodic ? 4 * (1 + 1e-6) : 2) * scene.radius);
    };
    const double most = std::min({std::sqrt(densest / scene.packing()),
                                  room(scene.box.x, scene.effects.is_periodic_x()),
                                  room(scene.box.y, scene.effects.is_periodic_y())});
    if (growth <= most || most < 1) return; // no room at the start is told elsewhere
    check.refuse({"effects.growth.rate"},
                 fmt::format("after {} steps discs of radius {:g} would cover {:.4g} of the box; "
                             "there is room for them up to step {:.0f}",
                             scene.steps, scene.radius * growth, scene.last_packing(),
                             std::floor((most - 1) / scene.effects.growth)));
}

/// A last step of 0 shows the start, and measures nothing.
void check_first_sample(const Check& check, std::string_view key, std::int64_t from) {
    const std::int64_t last = check.scene.steps;
    if (from > last && last > 0)
        check.refuse({key},
                     fmt::format("'{}' = {} lies beyond the last step, {}", key, from, last));
}

void check_samples(const Check& check) {
    check_first_sample(check, "output.averages_from_step", check.scene.averages_from);
    if (!check.scene.measurements) return;
    const MeasurementOutput& output = *check.scene.measurements;
    check_first_sample(check, "output.measurements.from_step", output.from_step);
    const std::int64_t steps = check.scene.steps - output.from_step;
    const std::int64_t n_samples = steps / output.every_steps;
    const std::vector<Quantity>& all = declared_quantities();
    const bool has_history = std::any_of(all.begin(), all.end(), [&output](const Quantity& one) {
        return one.has_history && output.measures(one.name);
    });
    if (!has_history || n_samples <= most_samples_of_histories) return;
    check.refuse({"output.measurements.every_steps", quantities_key},
                 fmt::format("{} samples of quantities that have a history are more than {}; take "
                             "output.measurements.every_steps = {}",
                             n_samples, most_samples_of_histories,
                             steps / most_samples_of_histories + 1));
}

} // namespace

void check_times(const Check& check) {
    Scene& scene = check.scene;
    if (scene.steps > largest_steps / scene.micro_steps)
        check.refuse({"time.steps"}, fmt::format("{} steps of {} micro-steps are more than 2^53 "
                                                 "micro-steps",
                                                 scene.steps, scene.micro_steps));
    if (!std::has_single_bit(static_cast<std::uint64_t>(scene.micro_steps)))
        scene.warnings.push_back(fmt::format(
            "time.micro_steps = {} is not a power of two: velocities are rounded when they are "
            "divided by it",
            scene.micro_steps));
    if (scene.precision == Precision::single && scene.sync_every > longest_single_sync)
        check.refuse({"time.precision"},
                     fmt::format("precision = \"single\" counts micro-steps up to {} between "
                                 "syncs; 'time.sync_every' is {}",
                                 longest_single_sync, scene.sync_every));
    const double interval = steps_between_syncs(scene);
    if (scene.effects.drag * interval > longest_drag)
        check.refuse({"effects.drag.rate"},
                     fmt::format("'effects.drag.rate' = {} leaves less than a fiftieth of a "
                                 "velocity from sync to sync: {:g} at most, or a smaller "
                                 "time.sync_every",
                                 scene.effects.drag, longest_drag / interval));
    check_contact_time(check);
    check_samples(check);
    check_times_of_quantities(check);
}

void check_room(const Check& check) {
    check_fall(check);
    check_periodic_box(check);
    check_thermal_walls(check);
    check_moving_walls(check);
    check_oscillating_walls(check);
    check_growth(check);
    check_obstacles(check);
    check_quantities(check);
}

} // namespace carrom
