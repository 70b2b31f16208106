// SPDX-License-Identifier: BSD-3-Clause
// Lines and lattices: cradles, chains of conflicts, ties and break shots. They cross every strip
// and block.
#include <algorithm>
#include <array>

#include "scene_tools.hpp"

namespace carrom::test {

namespace {

/// Adds the scene with its ids, with reversed ids, and with random ids; each along x and along y.
void add_variants(std::vector<TestScene>& scenes, const TestScene& scene, std::uint64_t seed) {
    TestScene reversed = scene;
    reversed.name += ", ids reversed";
    for (InputDisc& disc : reversed.discs) disc.id = scene.discs.size() - 1 - disc.id;
    const TestScene dealt = shuffled(scene, seed);
    for (const TestScene& variant : {scene, reversed, dealt}) {
        scenes.push_back(variant);
        scenes.push_back(transposed(variant));
    }
}

} // namespace

std::vector<TestScene> cradles() {
    std::vector<TestScene> scenes;
    std::uint64_t seed = 700;
    for (const std::size_t n : {std::size_t{2}, std::size_t{7}, std::size_t{40}}) {
        for (const double gap : {0.0, 0.125, 1.0}) {
            for (const double speed : {0.25, 5.0}) {
                TestScene scene = cradle(n, 0.5, gap, speed);
                scene.is_exact = speed == 0.25;
                scene.cascades_when_event_driven = gap == 0;
                add_variants(scenes, scene, ++seed);
            }
        }
    }
    for (const double gap : {0.0, 0.07}) {
        TestScene scene = cradle(30, 0.3, gap, 0.9);
        scene.cascades_when_event_driven = gap == 0;
        add_variants(scenes, scene, ++seed);
        scene.name += ", both ends move";
        scene.discs.back().vx = -0.9;
        add_variants(scenes, scene, ++seed);
    }
    return scenes;
}

std::vector<TestScene> chains() {
    std::vector<TestScene> scenes;
    std::uint64_t seed = 800;
    for (const char* kind : {"rising", "falling", "tied", "mixed"}) {
        for (const std::size_t n : {std::size_t{6}, std::size_t{24}, std::size_t{60}}) {
            TestScene scene = chain(n, kind, ++seed);
            scene.setting.sync_every = std::array{64, 1, 4}[seed % 3];
            add_variants(scenes, scene, seed);
            add_variants(scenes, zigzag(n, kind, seed), seed);
        }
        scenes.push_back(zigzag(400, kind, ++seed));
    }
    scenes.push_back(shuffled(chain(400, "tied", 890), 890));
    scenes.push_back(chain(400, "rising", 891));
    return scenes;
}

std::vector<TestScene> lattices() {
    std::vector<TestScene> scenes;
    std::uint64_t seed = 900;
    for (const std::size_t k : {std::size_t{4}, std::size_t{7}, std::size_t{20}}) {
        for (const double spacing : {1.0, 1.25, 2.0}) {
            // Columns that fly towards each other: all contacts of two columns, and all with walls,
            // are at the same time.
            TestScene columns = lattice(k, spacing);
            columns.name += ", columns in turn";
            columns.is_exact = true;
            columns.cascades_when_event_driven = spacing == 1;
            for (std::size_t i = 0; i < k * k; ++i)
                columns.discs[i].vx = i % k % 2 == 0 ? 0.25 : -0.25;
            scenes.push_back(columns);
            scenes.push_back(shuffled(transposed(columns), ++seed));

            // Every disc's four neighbours reach it at the same time.
            TestScene collapse = lattice(k, spacing);
            collapse.name += ", collapsing";
            for (InputDisc& disc : collapse.discs) {
                disc.vx = (collapse.setting.box_size / 2 - disc.x) / 8;
                disc.vy = (collapse.setting.box_size / 2 - disc.y) / 8;
            }
            if (spacing > 1) scenes.push_back(collapse);
            if (spacing > 1) scenes.push_back(shuffled(collapse, ++seed));

            TestScene kicked = lattice(k, spacing);
            kicked.name += ", one kicked";
            kicked.cascades_when_event_driven = spacing == 1;
            kicked.discs[k + 1].vx = 0.75;
            kicked.discs[k + 1].vy = 0.5;
            scenes.push_back(kicked);
        }
    }
    return scenes;
}

std::vector<TestScene> breaks() {
    std::vector<TestScene> scenes;
    std::uint64_t seed = 1000;
    for (const std::size_t rows : {std::size_t{2}, std::size_t{5}, std::size_t{10}}) {
        for (const double radius : {0.5, 0.3}) {
            for (const double aim : {0.0, 0.3}) {
                TestScene scene = break_shot(rows, radius, rows == 5 ? 11 : 1.7, aim);
                scene.setting.sync_every = std::array{64, 2}[++seed % 2];
                scenes.push_back(scene);
                scenes.push_back(shuffled(transposed(scene), seed));
            }
        }
    }
    return scenes;
}

} // namespace carrom::test
