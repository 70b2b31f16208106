// SPDX-License-Identifier: BSD-3-Clause
// Discs whose radii differ by up to a factor of 30 have the bits of the references of both methods,
// which search all pairs: between walls, periodic and sheared sides.
#include <string>
#include <vector>

#include "periodic_bits.hpp"
#include "periodic_scenes.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// Large discs of radius `ratio` and small ones of radius 1, placed at random without overlaps.
/// Some small discs fly as far as a large disc is wide in a micro-step.
TestScene unequal(double ratio, std::uint64_t n_large, std::uint64_t n_small, double box_size,
                  double speed, const std::array<Boundary, 4>& boundaries, std::uint64_t seed) {
    TestScene scene = empty_scene("radii 1 and " + number(ratio) + " " + name_of(boundaries),
                                  box_size, ratio, 10);
    scene.setting.effects.species = {{n_large, ratio, ratio * ratio}, {n_small, 1, 1}};
    scene.setting.effects.boundaries = boundaries;
    scene.setting.sync_every = 5;
    scene.setting.micro_steps = 2;
    Random random(seed);
    add_species(scene, boundaries[0] == periodic, boundaries[2] == periodic, random);
    set_speeds(scene, speed, random);
    return scene;
}

std::vector<TestScene> scenes_of_unequal(const std::array<Boundary, 4>& boundaries) {
    std::vector<TestScene> scenes = {unequal(3, 12, 150, 44, 1.5, boundaries, 921),
                                     unequal(10, 4, 150, 75, 6, boundaries, 922),
                                     unequal(30, 2, 120, 140, 3, boundaries, 923),
                                     unequal(30, 1, 100, 100, 40, boundaries, 924)};
    scenes.back().steps = 3;
    return scenes;
}

} // namespace

TEST_CASE("periodic: discs of very unequal sizes have the references' bits in both methods") {
    const std::array<Boundary, 4> walls{};
    for (const auto& boundaries : {both, along_x, walls})
        for (const TestScene& scene : scenes_of_unequal(boundaries))
            for (const Method method : {Method::time_stepped, Method::event_driven})
                check_bits(scene, method);
}

TEST_CASE("periodic: discs of very unequal sizes that lose energy have the references' bits") {
    for (TestScene scene : scenes_of_unequal(along_y)) {
        scene.setting.effects.contact = {ContactKind::restitution, 0.8, 0.001};
        for (const Method method : {Method::time_stepped, Method::event_driven})
            check_bits(scene, method);
        scene.setting.effects.gravity = {0.01, 0};
        check_bits(scene, Method::event_driven);
    }
}

TEST_CASE("periodic: discs of very unequal sizes have the references' bits under shear") {
    constexpr Boundary sliding{BoundaryKind::sheared, 1, 0, 0};
    for (TestScene scene : scenes_of_unequal(both)) {
        scene.setting.effects.boundaries = {periodic, periodic, sliding, sliding};
        scene.setting.effects.shear = 1.5 / scene.setting.box().y;
        scene.name += ", sheared";
        for (const Method method : {Method::time_stepped, Method::event_driven})
            check_bits(scene, method);
    }
}
