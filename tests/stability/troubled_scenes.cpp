// SPDX-License-Identifier: BSD-3-Clause
#include "troubled_scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "carrom/scene/read_scene.hpp"
#include "scene_tools.hpp"

namespace carrom::test {

namespace {

/// Of the unit circle: the axes, exact diagonals, hexagonal neighbours, or anything.
std::pair<double, double> troubled_direction(Random& random) {
    const double h = std::sqrt(0.75);
    const std::array<std::pair<double, double>, 6> directions = {{{1, 0}, {0, 1}, {0.6, 0.8}, {-0.8, 0.6}, {0.5, h}, {-h, 0.5}}};
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
    case 1: if (!scene.discs.empty()) return {scene.discs.back().vx, scene.discs.back().vy}; break;
    case 2: if (!scene.discs.empty()) return {-scene.discs.back().vx, -scene.discs.back().vy}; break;
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
        return std::sqrt((disc.x - x) * (disc.x - x) + (disc.y - y) * (disc.y - y)) < sigma * (1 - 0x1p-50);
    });
}

/// Calls `change(scene)` on a copy and keeps it if it still fails.
template <class Change> bool keep_if_it_fails(TestScene& scene, const std::function<bool(const TestScene&)>& fails, const Change& change) {
    TestScene trial = scene;
    change(trial);
    if (!fails(trial)) return false;
    scene = trial;
    return true;
}

void leave_out(TestScene& scene, std::size_t place) {
    const DiscId gone = scene.discs[place].id;
    scene.discs.erase(scene.discs.begin() + static_cast<std::ptrdiff_t>(place));
    for (InputDisc& disc : scene.discs) disc.id -= disc.id > gone;
}

} // namespace

TestScene troubled_scene(std::uint64_t seed) {
    Random random(seed);
    const double radius = std::array{0.5, 0.25, 0.3}[random.index(3)];
    TestScene scene = empty_scene("troubled scene " + std::to_string(seed), std::array{4.0, 6.0, 7.3}[random.index(3)], radius, 8);
    scene.setting.sync_every = std::array{1, 2, 3, 64}[random.index(4)];
    scene.setting.micro_steps = std::array{1, 1, 2, 4}[random.index(4)];
    const std::size_t most = 1 + random.index(10);
    for (int tries = 0; tries < 100 && scene.discs.size() < most; ++tries) {
        double x = troubled_place(scene, random), y = troubled_place(scene, random);
        if (!scene.discs.empty() && random.index(2) == 0) { // touch another one, or all but
            const InputDisc& other = scene.discs[random.index(scene.discs.size())];
            const auto [ex, ey] = troubled_direction(random);
            const double distance = 2 * radius * (1 + std::array{0.0, 0.0, 0x1p-50, 1e-9, 0.25}[random.index(5)]);
            x = other.x + distance * ex;
            y = other.y + distance * ey;
        }
        if (!is_free(scene, x, y)) continue;
        const auto [vx, vy] = troubled_velocity(scene, random);
        add_disc(scene, x, y, vx, vy);
    }
    return scene;
}

TestScene shrunk(TestScene scene, const std::function<bool(const TestScene&)>& fails) {
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (std::size_t i = scene.discs.size(); i-- > 0 && scene.discs.size() > 1;)
            has_changed |= keep_if_it_fails(scene, fails, [i](TestScene& trial) { leave_out(trial, i); });
        while (scene.steps > 1 && keep_if_it_fails(scene, fails, [](TestScene& trial) { trial.steps -= 1; })) has_changed = true;
        for (InputDisc& disc : scene.discs) {
            for (double InputDisc::*const number : {&InputDisc::vx, &InputDisc::vy, &InputDisc::x, &InputDisc::y}) {
                const double rounded = std::round(16 * (disc.*number)) / 16;
                if (rounded == disc.*number) continue;
                const auto place = &disc - scene.discs.data();
                has_changed |= keep_if_it_fails(scene, fails, [&](TestScene& trial) {
                    trial.discs[static_cast<std::size_t>(place)].*number = rounded;
                });
            }
        }
    }
    return scene;
}

std::string toml_of(const TestScene& scene) {
    std::vector<InputDisc> discs = scene.discs;
    std::sort(discs.begin(), discs.end(), [](const InputDisc& a, const InputDisc& b) { return a.id < b.id; });
    std::string rows;
    for (const InputDisc& disc : discs) rows += fmt::format("  [{:.17g}, {:.17g}, {:.17g}, {:.17g}],\n", disc.x, disc.y, disc.vx, disc.vy);
    return fmt::format("[box]\nsize = {:.17g}\n[discs]\nradius = {:.17g}\nlist = [\n{}]\n[time]\nsteps = {}\nmicro_steps = {}\nsync_every = {}\n",
                       scene.setting.box_size, scene.setting.radius, rows, scene.steps, scene.setting.micro_steps,
                       scene.setting.sync_every);
}

TestScene read_regression(const std::string& path) {
    std::ifstream file(path);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const Scene read = read_scene(text, path);
    TestScene scene = empty_scene(path, read.box_size, read.radius, read.steps);
    scene.setting.micro_steps = read.micro_steps;
    scene.setting.sync_every = read.sync_every;
    scene.discs = read.listed_discs;
    return scene;
}

} // namespace carrom::test
