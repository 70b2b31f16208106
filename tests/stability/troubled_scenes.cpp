// SPDX-License-Identifier: BSD-3-Clause
#include "troubled_scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "scene_tools.hpp"

namespace carrom::test {

namespace {

/// A direction: an axis, an exact diagonal, a hexagonal neighbour, or any other.
std::pair<double, double> troubled_direction(Random& random) {
    const double h = std::sqrt(0.75);
    const std::array<std::pair<double, double>, 6> directions = {
        {{1, 0}, {0, 1}, {0.6, 0.8}, {-0.8, 0.6}, {0.5, h}, {-h, 0.5}}};
    if (random.index(4) == 0) return random.direction();
    const auto [x, y] = directions[random.index(directions.size())];
    return random.index(2) == 0 ? std::pair(x, y) : std::pair(-x, -y);
}

double troubled_place(const TestScene& scene, Random& random) {
    const double low = scene.setting.radius, high = scene.setting.box_size - low;
    switch (random.index(5)) {
    case 0: return low;
    case 1: return high;
    case 2: return random.uniform(low, high);
    default: return std::clamp(std::floor(4 * random.uniform(low, high)) / 4, low, high);
    }
}

std::pair<double, double> troubled_velocity(const TestScene& scene, Random& random) {
    const double size = std::array{0.25, 0.5, 1.0, 3.0, 1e-9}[random.index(5)];
    switch (random.index(6)) {
    case 0: return {0, 0};
    case 1:
        if (!scene.discs.empty()) return {scene.discs.back().vx, scene.discs.back().vy};
        break;
    case 2:
        if (!scene.discs.empty()) return {-scene.discs.back().vx, -scene.discs.back().vy};
        break;
    case 3: return {random.uniform(-size, size), random.uniform(-size, size)};
    default: break;
    }
    const auto [x, y] = troubled_direction(random);
    return {size * x, size * y};
}

bool is_free(const TestScene& scene, double x, double y) {
    const double low = scene.setting.radius, high = scene.setting.box_size - low, sigma = 2 * low;
    if (x < low || x > high || y < low || y > high) return false;
    return std::none_of(scene.discs.begin(), scene.discs.end(), [&](const InputDisc& disc) {
        return std::sqrt((disc.x - x) * (disc.x - x) + (disc.y - y) * (disc.y - y)) <
               sigma * (1 - 0x1p-50);
    });
}

} // namespace

TestScene troubled_scene(std::uint64_t seed) {
    Random random(seed);
    const double radius = std::array{0.5, 0.25, 0.3}[random.index(3)];
    TestScene scene = empty_scene("troubled scene " + std::to_string(seed),
                                  std::array{4.0, 6.0, 7.3}[random.index(3)], radius, 8);
    scene.setting.sync_every = std::array{1, 2, 3, 64}[random.index(4)];
    scene.setting.micro_steps = std::array{1, 1, 2, 4}[random.index(4)];
    const std::size_t most = 1 + random.index(10);
    for (int tries = 0; tries < 100 && scene.discs.size() < most; ++tries) {
        double x = troubled_place(scene, random), y = troubled_place(scene, random);
        if (!scene.discs.empty() && random.index(2) == 0) { // touches another disc, or nearly does
            const InputDisc& other = scene.discs[random.index(scene.discs.size())];
            const auto [ex, ey] = troubled_direction(random);
            const double distance = 2 * radius *
                                    (1 +
                                     std::array{0.0, 0.0, 0x1p-50, 1e-9, 0.25}[random.index(5)]);
            x = other.x + distance * ex;
            y = other.y + distance * ey;
        }
        if (!is_free(scene, x, y)) continue;
        const auto [vx, vy] = troubled_velocity(scene, random);
        add_disc(scene, x, y, vx, vy);
    }
    return scene;
}

namespace {

/// Adds a patch of a hexagonal lattice around (x, y), as far as its places are free.
void add_patch(TestScene& scene, double x, double y, double spacing, double vx, double vy) {
    for (const double row : {0.0, 1.0, -1.0}) {
        for (const double column : {0.0, 1.0, -1.0}) {
            const double px = x + spacing * (column + 0.5 * std::fabs(row)),
                         py = y + spacing * std::sqrt(0.75) * row;
            if (is_free(scene, px, py)) add_disc(scene, px, py, vx, vy);
        }
    }
}

/// Sizes of the box, from one that is hardly large enough to one in which discs are hard to find.
double wild_box_size(double radius, Random& random) {
    switch (random.index(6)) {
    case 0: return 2 * radius * (1 + std::array{0x1p-50, 1e-9, 1e-3, 0.5}[random.index(4)]);
    case 1: return radius * std::array{1e2, 1e4, 1e6}[random.index(3)];
    default: return radius * std::array{8.0, 12.0, 14.6, 30.0}[random.index(4)];
    }
}

} // namespace

TestScene wildly_troubled_scene(std::uint64_t seed, bool may_overlap) {
    Random random(seed);
    const double radius = std::array{0.5, 0.3, 1.0}[random.index(3)], sigma = 2 * radius;
    TestScene scene = empty_scene("wildly troubled scene " + std::to_string(seed),
                                  wild_box_size(radius, random), radius, 6);
    scene.setting.sync_every = std::array<std::int64_t, 5>{1, 3, 5, 64, 100000}[random.index(5)];
    scene.setting.micro_steps = std::array<std::int64_t, 5>{1, 1, 2, 3, 7}[random.index(5)];
    const double gap = std::array{0.0, 0x1p-52, 0x1p-48, 1e-12, 1e-6, 0.1}[random.index(6)];
    const double speed =
        sigma *
        std::array{1e-12, 1e-3, 0.3, 1.0, 10.0, 1e3, 1e9}[random.index(7)]; // factor of velocities
    const std::size_t most = 1 + random.index(random.index(3) == 0 ? 40 : 8);
    for (int tries = 0; tries < 200 && scene.discs.size() < most; ++tries) {
        double x = troubled_place(scene, random), y = troubled_place(scene, random);
        auto [vx, vy] = troubled_velocity(scene, random);
        if (!scene.discs.empty() &&
            random.index(3) != 0) { // beside another disc, aimed at it, or inside it
            const InputDisc& other = scene.discs[random.index(scene.discs.size())];
            const auto [ex, ey] = troubled_direction(random);
            const bool is_aimed = random.index(2) == 0;
            const double distance = may_overlap && random.index(8) == 0
                                        ? sigma * random.uniform(0, 1)
                                    : is_aimed
                                        ? sigma * (1 + gap) + 3 * speed * random.uniform(0, 1)
                                        : sigma * (1 + gap);
            x = other.x + distance * ex;
            y = other.y + distance * ey;
            if (is_aimed) std::tie(vx, vy) = std::pair(other.vx - ex, other.vy - ey);
            if (random.index(4) == 0)
                std::tie(vx, vy) = std::pair(std::nextafter(other.vx, 1e300), other.vy);
        }
        const double low = radius, high = scene.setting.box_size - radius;
        if (may_overlap ? x < low || x > high || y < low || y > high : !is_free(scene, x, y))
            continue;
        if (random.index(6) == 0)
            add_patch(scene, x, y, sigma * (1 + gap), vx, vy);
        else
            add_disc(scene, x, y, vx, vy);
    }
    if (scene.discs.empty())
        add_disc(scene, scene.setting.box_size / 2, scene.setting.box_size / 2, 1, 0);
    for (InputDisc& disc : scene.discs) {
        disc.vx *= speed;
        disc.vy *= speed;
    }
    return random.index(3) == 0 ? scaled(scene, static_cast<int>(random.index(400)) - 200) : scene;
}

} // namespace carrom::test
