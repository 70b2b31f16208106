// SPDX-License-Identifier: BSD-3-Clause
// Scenes for boxes with periodic sides.
#pragma once

#include "catch.hpp"
#include "core/state_hash.hpp"
#include "effect_runs.hpp"
#include "event_driven.hpp"
#include "scene_tools.hpp"
#include "shape_parts.hpp"
#include "time_stepped.hpp"
#include <array>
#include <cmath>
#include <cstdlib>
#include <omp.h>
#include <optional>
#include <string>
#include <vector>

namespace carrom::test {

inline constexpr Boundary periodic{BoundaryKind::periodic, 1, 0, 0};
inline constexpr std::array<Boundary, 4> both{periodic, periodic, periodic, periodic},
    along_x{periodic, periodic, Boundary{}, Boundary{}},
    along_y{Boundary{}, Boundary{}, periodic, periodic};

inline const char* name_of(const std::array<Boundary, 4>& boundaries) {
    return boundaries == both ? "both" : boundaries == along_x ? "x" : "y";
}

/// Shifts all discs; those that leave the box come in again at the opposite side.
inline TestScene moved(TestScene scene, double dx, double dy) {
    const double length = scene.setting.box_size;
    for (InputDisc& disc : scene.discs) {
        disc.x = std::fmod(disc.x + dx * length, length);
        disc.y = std::fmod(disc.y + dy * length, length);
    }
    return scene;
}

/// Along an axis with walls, discs are not shifted, so that they do not cross the walls.
inline TestScene moved_along(const TestScene& scene, const std::array<Boundary, 4>& boundaries) {
    TestScene result = moved(scene, boundaries[0] == periodic ? 0.3125 : 0,
                             boundaries[2] == periodic ? 0.46875 : 0);
    result.setting.effects.boundaries = boundaries;
    result.name += std::string(", periodic ") + name_of(boundaries);
    return result;
}

/// A row of discs along a whole axis, through the seam, the first of which is hit. Gaps are equal,
/// or all discs but one touch.
inline TestScene ring(std::size_t n, double gap, bool is_along_y) {
    const double pitch = 2 + gap, length = static_cast<double>(n) * pitch + (gap == 0 ? 1 : 0);
    TestScene scene = empty_scene("ring of " + std::to_string(n) + ", gap " + number(gap), length,
                                  1, 14);
    for (std::size_t i = 0; i < n; ++i) {
        const double place = std::fmod(length - 1.5 + static_cast<double>(i) * pitch, length);
        if (is_along_y)
            add_disc(scene, length / 2, place, 0, i == 0 ? 1.5 : 0);
        else
            add_disc(scene, place, length / 2, i == 0 ? 1.5 : 0, 0);
    }
    return scene;
}

/// Discs that all collide at one time, across both seams.
inline TestScene tied(std::size_t k) {
    TestScene scene = lattice(k, 1.5);
    scene.name = "tied lattice of " + std::to_string(k * k);
    scene.steps = 10;
    for (std::size_t i = 0; i < scene.discs.size(); ++i) {
        scene.discs[i].vx = (i + i / k) % 2 == 0 ? 0.5 : -0.5;
        scene.discs[i].vy = (i / k) % 2 == 0 ? 0.25 : -0.25;
    }
    return scene;
}

/// Two discs in a box that barely has room for each disc between the images of the other.
inline TestScene narrow() {
    TestScene scene = empty_scene("two discs in a narrow box", 4 * (1 + 2e-6), 1, 40);
    add_disc(scene, 1.1, 1.2, 0.7, 0.31);
    add_disc(scene, 2.9, 3.1, -0.45, -0.77);
    return scene;
}

/// A few discs that fly through the box many times between syncs.
inline TestScene fast(std::size_t n) {
    TestScene scene = gas(n, 0.1, 1, 811);
    scene.name = "fast gas of " + std::to_string(n);
    for (InputDisc& disc : scene.discs) {
        disc.vx *= 0.15 * scene.setting.box_size;
        disc.vy *= 0.15 * scene.setting.box_size;
    }
    scene.steps = 5;
    return scene;
}

/// Left and right sides are thermal, bottom and top periodic: all images of a disc draw the same
/// random numbers.
inline TestScene between_warm_walls(const TestScene& base) {
    TestScene scene = moved_along(base, along_y);
    scene.setting.effects.boundaries[0] = {BoundaryKind::thermal, 1, 0.3, 0};
    scene.setting.effects.boundaries[1] = {BoundaryKind::thermal, 1, 0.1, 0};
    set_thermal_seed(scene.setting, 77);
    scene.name += ", warm walls";
    return scene;
}

/// Obstacles at a corner and at the seams, with images on all sides; segments that end on a seam,
/// run along a seam or stand near one.
inline TestScene among_bodies(const TestScene& base, const std::array<Boundary, 4>& boundaries) {
    TestScene scene = moved_along(base, boundaries);
    const double size = scene.setting.box_size;
    scene.setting.effects.fixed_bodies = {
        {{0, 0, 0.08 * size}, {0.99 * size, 0.5 * size, 0.04 * size}, {0.4 * size, size, 0}},
        {{0, 0.3 * size, 0.2 * size, 0.35 * size},
         {0.995 * size, 0.7 * size, 0.995 * size, 0.9 * size},
         {0.6 * size, size, 0.7 * size, 0.85 * size}},
        0.9};
    make_room_for_obstacles(scene);
    scene.name += ", bodies";
    return scene;
}

/// One disc, which flies through the box `speed` times in a step, and an obstacle at the corner.
inline TestScene sinai(const char* name, double radius, double reach, double speed, double x,
                       double y, double angle) {
    TestScene scene = empty_scene(name, 10, radius, 12);
    scene.setting.sync_every = 5;
    scene.setting.effects.boundaries = both;
    scene.setting.effects.fixed_bodies.discs = {{0, 0, reach - radius}};
    add_disc(scene, x, y, 10 * speed * std::cos(angle), 10 * speed * std::sin(angle));
    return scene;
}

/// Scenes with little room; with no gap between obstacles, where a disc is trapped and may touch
/// two images of an obstacle at once; with flights of many boxes; and with a disc on a seam that
/// touches an obstacle from the other side.
inline std::vector<TestScene> scenes_of_one_disc() {
    TestScene touching = sinai("a disc on the seam at a body", 1, 3, 0.3, 0, 5, 0.2);
    touching.setting.effects.fixed_bodies.discs = {{7, 5, 2}};
    return {sinai("a body of nearly half the box", 0.5, 4.9, 0.7, 5, 5, 0.3),
            sinai("a trap", 1, 6, 0.5, 5, 5, 0.4),
            sinai("a trap, along its axis", 1, 6, 0.5, 5, 5, std::acos(0.0)),
            sinai("far flights", 0.001, 0.002, 60, 3, 4, 0.7), touching};
}

inline std::vector<TestScene> base_scenes() {
    std::vector<TestScene> scenes{gas(120, 0.05, 0.8, 801),
                                  gas(100, 0.6, 0.3, 802),
                                  ring(7, 0.5, false),
                                  ring(6, 0, true),
                                  tied(6),
                                  narrow(),
                                  fast(40)};
    for (TestScene& scene : scenes) {
        if (scene.steps == 40 && scene.discs.size() > 2) scene.steps = 14;
        scene.setting.sync_every = 5;
        scene.setting.micro_steps = 2;
    }
    return scenes;
}

/// Large discs first, then small ones, at random positions without overlaps, images included.
/// Speeds are in large diameters per step.
inline TestScene mixture(const std::vector<Species>& species, double box_size, double speed,
                         std::uint64_t seed) {
    TestScene scene = empty_scene("mixture " + std::to_string(seed), box_size,
                                  species.front().radius, 8);
    scene.setting.effects.species = species;
    scene.setting.sync_every = 5;
    scene.setting.micro_steps = 2;
    Random random(seed);
    add_species(scene, true, true, random);
    set_speeds(scene, 2 * species.front().radius * speed, random);
    scene.setting.effects.boundaries = both;
    return scene;
}

/// Masses that are not a function of radii; sizes 1 : 50; more species than are searched one by
/// one; few discs with many images.
inline std::vector<TestScene> mixtures() {
    std::vector<Species> many;
    for (int k = 0; k < 20; ++k)
        many.push_back({1 + static_cast<std::uint64_t>(k % 3), 2 - 0.08 * k, 1 + 0.5 * (k % 4)});
    return {mixture({{3, 2.5, 3}, {14, 1, 1.3}, {24, 0.3, 0.2}}, 16, 0.15, 821),
            mixture({{2, 5, 40}, {30, 0.1, 0.1}}, 21, 0.04, 822), mixture(many, 22, 0.4, 823),
            mixture({{1, 1, 1}, {2, 0.4, 0.2}}, 4 * (1 + 2e-6), 1.5, 824),
            mixture({{1, 2, 7}}, 9, 3, 825)};
}

/// The scene between two walls. Discs that overlap the walls are moved aside.
inline TestScene between_walls(TestScene scene, const std::array<Boundary, 4>& boundaries) {
    scene.setting.effects.boundaries = boundaries;
    const double length = scene.setting.box_size;
    std::vector<InputDisc> discs;
    discs.swap(scene.discs);
    std::vector<Species> species;
    for (const InputDisc& disc : discs) {
        const Species body = scene.setting.species_of(disc.id);
        const auto fits = [&](const Boundary& side, double place) {
            return side == periodic || (place > body.radius && place < length - body.radius);
        };
        if (!fits(boundaries[0], disc.x) || !fits(boundaries[2], disc.y)) continue;
        add_disc(scene, disc.x, disc.y, disc.vx, disc.vy);
        species.push_back({1, body.radius, body.mass});
    }
    if (!scene.setting.effects.species.empty()) scene.setting.effects.species = species;
    scene.name += std::string(", periodic ") + name_of(boundaries);
    return scene;
}

inline ContactEffect rough(double restitution, double tangential, double friction) {
    return {ContactKind::rough, restitution, 0.002, tangential, friction, 0.5};
}

/// Makes every second disc smaller and lighter.
inline void split_into_species(TestScene& scene) {
    const double radius = scene.setting.radius;
    scene.setting.effects.species.clear();
    for (std::size_t k = 0; k < scene.discs.size(); ++k)
        scene.setting.effects.species.push_back(k % 2 == 0 ? Species{1, radius, 2}
                                                           : Species{1, 0.6 * radius, 0.5});
}

} // namespace carrom::test
