// SPDX-License-Identifier: BSD-3-Clause
// Walls and boundaries in time: corners, bands, boxes that are hardly large enough, contacts at the
// very end of a micro-step.
#include <array>
#include <cmath>
#include <limits>

#include "scene_tools.hpp"

namespace carrom::test {

namespace {

void add_corner_shots(std::vector<TestScene>& scenes) {
    for (const double speed : {0.5, 1.0, 3.7, 90.0}) {
        for (const double offset : {0.0, 0x1p-50, 1e-9, 1e-7, 1e-3}) {
            TestScene scene = empty_scene("corner shots, speed " + number(speed) + ", off by " +
                                              number(offset),
                                          7.3, 0.3, 40);
            add_disc(scene, 1.3 + offset, 1.3, -speed, -speed);
            add_disc(scene, 6.0, 6.0 + offset, speed, speed);
            add_disc(scene, 1.3, 6.0 - offset, -speed, speed);
            add_disc(scene, 6.0 - offset, 1.3, speed, -speed);
            add_disc(scene, 3.65, 3.65, 0.5 * speed, 0.5 * speed);
            scene.setting.micro_steps = speed == 1 ? 4 : 1;
            scenes.push_back(scene);
        }
    }
    TestScene exact = empty_scene("corner shots, exact", 8, 1, 40);
    exact.is_exact = true;
    add_disc(exact, 3, 3, -0.5, -0.5);
    scenes.push_back(exact);
}

/// Boxes of one disc's width, exactly and nearly, and of two discs' width.
void add_tight_boxes(std::vector<TestScene>& scenes) {
    for (const double room : {0.0, 0x1p-52, 0x1p-40, 1e-8, 0.5}) {
        for (const double speed : {0.0, 1e-9, 0.3, 50.0}) {
            const double box_size = 2 * (1 + room);
            TestScene scene = empty_scene("a disc that fills the box, room " + number(room) +
                                              ", speed " + number(speed),
                                          box_size, 1, 20);
            scene.cascades_when_event_driven = room < 1e-3 && speed > 0;
            add_disc(scene, box_size / 2, box_size / 2, speed, -0.75 * speed);
            scenes.push_back(scene);
        }
    }
    for (const double speed : {0.125, 3.0}) {
        TestScene scene = empty_scene("four discs that fill the box, speed " + number(speed), 4, 1,
                                      30);
        scene.cascades_when_event_driven = true;
        add_disc(scene, 1, 1, speed, 0.5 * speed);
        add_disc(scene, 3, 1, 0, -speed);
        add_disc(scene, 1, 3, -speed, -speed);
        add_disc(scene, 3, 3);
        scenes.push_back(scene);
    }
}

/// Discs exactly at walls, in the band before them, and an ulp beyond them; slow ones may never
/// touch.
void add_wall_huggers(std::vector<TestScene>& scenes) {
    const double radius = 0.7, box_size = 30.1;
    for (const double speed : {1e-12, 1e-9, 0.01, 2.0, 60.0}) {
        TestScene scene = empty_scene("discs at the walls, speed " + number(speed), box_size,
                                      radius, 30);
        const double band = 1e-8 * radius;
        const std::array<double, 5> distances = {0, 0.5 * band, band, 1.5 * band, 1e-16};
        for (std::size_t i = 0; i < distances.size(); ++i) {
            const double place = 3 + 5 * static_cast<double>(i);
            const double near = radius + distances[i], far = (box_size - radius) - distances[i];
            const double along = i % 2 == 0 ? 0 : 0.3 * speed;
            add_disc(scene, near, place, -speed, along);
            add_disc(scene, far, place, speed, -along);
            add_disc(scene, place, near, along, -speed);
            add_disc(scene, place, far, -along, i == 3 ? -speed : speed);
        }
        scene.setting.sync_every = speed < 1 ? 64 : 3;
        scenes.push_back(scene);
        scenes.push_back(shuffled(scene, 1100));
    }
}

double by_ulps(double value, int ulps) {
    const double towards = ulps < 0 ? 0 : std::numeric_limits<double>::max();
    for (int i = 0; i < std::abs(ulps); ++i) value = std::nextafter(value, towards);
    return value;
}

/// Sixteen separate pairs whose contact is at micro-step `boundary` to within `ulps` of their
/// coordinates.
TestScene boundary_pairs(double ratio, std::int64_t boundary, std::int64_t sync_every, int ulps,
                         Random& random) {
    TestScene scene = empty_scene("contacts at " + std::to_string(boundary) + " to within " +
                                      std::to_string(ulps) + " ulp, sync every " +
                                      std::to_string(sync_every) + ", L/r " + number(ratio),
                                  ratio, 1, boundary + 2);
    scene.setting.sync_every = sync_every;
    const double cell = ratio / 4, time = static_cast<double>(boundary);
    const double fastest = 0.1 * cell / (time + 2);
    for (std::size_t i = 0; i < 16; ++i) {
        const auto [ex, ey] = random.direction();
        const auto [fx, fy] = random.direction();
        const double speed = fastest * std::pow(2.0, -static_cast<double>(random.index(8)));
        const double drift = 0.3 * speed;
        const double x = (static_cast<double>(i % 4) + 0.5) * cell,
                     y = (static_cast<double>(i / 4) + 0.5) * cell;
        const double px = x - ex, py = y - ey, qx = x + ex, qy = y + ey;
        const double pvx = speed * ex + drift * fx, pvy = speed * ey + drift * fy;
        const double qvx = -0.5 * speed * ex + drift * fy, qvy = -0.5 * speed * ey + drift * fx;
        add_disc(scene, by_ulps(px - pvx * time, ulps), py - pvy * time, pvx, pvy);
        add_disc(scene, qx - qvx * time, by_ulps(qy - qvy * time, ulps), qvx, qvy);
    }
    scene.expected_pair_collisions = 16;
    return scene;
}

} // namespace

std::vector<TestScene> wall_scenes() {
    std::vector<TestScene> scenes;
    add_corner_shots(scenes);
    add_tight_boxes(scenes);
    add_wall_huggers(scenes);
    return scenes;
}

std::vector<TestScene> boundary_contacts() {
    std::vector<TestScene> scenes;
    Random random(1200);
    for (const double ratio : {1e2, 1e4, 1e6}) {
        for (const int ulps : {-40, -3, -1, 0, 1, 2, 17}) {
            scenes.push_back(boundary_pairs(ratio, 1, 1, ulps, random));
            scenes.push_back(boundary_pairs(ratio, 3, 64, ulps, random));
            scenes.push_back(shuffled(boundary_pairs(ratio, 8, 8, ulps, random), 1200));
            scenes.push_back(boundary_pairs(ratio, 64, 64, ulps, random));
        }
    }
    return scenes;
}

} // namespace carrom::test
