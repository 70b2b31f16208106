// SPDX-License-Identifier: BSD-3-Clause
#include "scene_tools.hpp"

namespace carrom::test {

std::vector<TestScene> small_scenes() {
    std::vector<TestScene> scenes;
    for (const auto family : {gases, still_gases, fast_scenes, cradles, chains, lattices, breaks,
                              wall_scenes, boundary_contacts, overlaps, tiny_velocities}) {
        const std::vector<TestScene> members = family();
        scenes.insert(scenes.end(), members.begin(), members.end());
    }
    return scenes;
}

std::vector<TestScene> large_scenes() {
    std::vector<TestScene> scenes;
    const auto add = [&scenes](TestScene scene, std::int64_t steps) {
        scene.steps = steps;
        scenes.push_back(shuffled(std::move(scene), 2000 + scenes.size()));
    };
    add(gas(2025, 0.1, 0.5, 2001), 20);
    add(gas(2025, 0.3, 0.02, 2002), 80);
    add(gas(2025, 0.3, 6, 2003), 10);
    add(gas(2025, 0.7, 0.1, 2004), 20);
    add(legacy_like(2000, 20000, 1, 2005), 10);
    add(legacy_like(2000, 250, 1, 2006), 4);
    add(chain(2000, "mixed", 2007), 2);
    add(zigzag(2000, "tied", 2008), 4);
    add(zigzag(2000, "rising", 2009), 4);
    add(transposed(zigzag(2000, "falling", 2010)), 4);
    // Discs in the order of their positions, so that the first tie decides the second, and so on
    // across the box.
    scenes.push_back(zigzag(2000, "tied", 2011));
    scenes.back().steps = 4;
    add(cradle(2000, 0.5, 0, 0.25), 20);
    add(lattice(45, 1.25), 1);
    for (InputDisc& disc : scenes.back().discs) {
        disc.vx = (28.125 - disc.x) / 8;
        disc.vy = (28.125 - disc.y) / 8;
    }
    scenes.back().steps = 10;
    add(break_shot(62, 0.5, 40, 0.1), 10);
    return scenes;
}

} // namespace carrom::test
