// SPDX-License-Identifier: BSD-3-Clause
#include "rectangle_scenes.hpp"

#include "dynamics/falling_contact.hpp"

namespace carrom::test {

namespace {

const ContactEffect elastic;

void add(std::vector<Case>& all, const TestScene& base, const char* what, const Effects& effects,
         bool is_for_both = true) {
    TestScene scene = base;
    scene.name += std::string(", ") + what;
    scene.setting.effects = effects;
    scene.setting.falling_contact = falling_contact;
    all.push_back({scene, Method::event_driven});
    if (is_for_both) all.push_back({scene, Method::time_stepped});
}

FixedBodyList bodies_in(const Box& box) {
    return {{{0.3 * box.x, 0.4 * box.y, 2}, {0.8 * box.x, 0.9 * box.y, 1.5}, {0, 0.2 * box.y, 1}},
            {{0.5 * box.x, 0.1 * box.y, 0.6 * box.x, 0.8 * box.y},
             {0.1 * box.x, 0.9 * box.y, 0.2 * box.x, 0.6 * box.y}},
            0.9};
}

void add_walled(std::vector<Case>& all, const TestScene& base) {
    const Boundary lossy{BoundaryKind::wall, 0.7, 0, 0}, open{BoundaryKind::open, 1, 0, 0},
        piston{BoundaryKind::moving, 1, 0, -0.03}, warm{BoundaryKind::thermal, 1, 0.3, 0},
        cold{BoundaryKind::thermal, 1, 0.1, 0};
    const ContactEffect inelastic{ContactKind::restitution, 0.85, 0.002};
    add(all, base, "plain", {});
    add(all, base, "lossy", {inelastic, {lossy, lossy, lossy, lossy}, {}});
    add(all, base, "open", {elastic, {open, Boundary{}, Boundary{}, open}, {}});
    add(all, base, "a piston and gravity",
        {elastic, {lossy, piston, Boundary{}, piston}, {0.01, -0.03}}, false);
    TestScene heated = base;
    set_thermal_seed(heated.setting, 77);
    Effects walls = heated.setting.effects;
    walls.boundaries = {warm, Boundary{}, cold, warm};
    add(all, heated, "warm walls", walls);
    TestScene dragged = base;
    set_drag(dragged, 0.2);
    add(all, dragged, "drag", dragged.setting.effects, false);
}

/// Makes every second disc smaller and lighter.
std::vector<Species> two_species(std::size_t n) {
    std::vector<Species> all;
    for (std::size_t k = 0; k < n; ++k)
        all.push_back(k % 2 == 0 ? Species{1, 1, 2} : Species{1, 0.6, 0.5});
    return all;
}

void add_pairs(std::vector<Case>& all, const TestScene& base) {
    const ContactEffect rough{ContactKind::rough, 0.9, 0.002, 0.5, 0.3, 0.4};
    Effects mixed;
    mixed.species = two_species(base.discs.size());
    add(all, base, "species", mixed);
    TestScene spinning = base;
    for (std::size_t k = 0; k < base.discs.size(); ++k)
        spinning.setting.first_spins.push_back(0.01 * (static_cast<double>(k % 7) - 3));
    add(all, spinning, "rough", {rough, {}, {}});
    add(all, spinning, "rough, periodic", {rough, all_round, {}});
}

void add_bodies(std::vector<Case>& all, const TestScene& base) {
    for (const auto& [boundaries, name] :
         {std::pair(std::array<Boundary, 4>{}, "bodies"), {all_round, "bodies, periodic"}}) {
        TestScene scene = base;
        scene.setting.effects.boundaries = boundaries;
        scene.setting.effects.fixed_bodies = bodies_in(scene.setting.box());
        make_room_for_obstacles(scene);
        add(all, scene, name, scene.setting.effects);
    }
}

} // namespace

TestScene rectangle(std::size_t columns, std::size_t rows, double pitch, double speed,
                    std::uint64_t seed) {
    TestScene scene = empty_scene("rectangle of " + std::to_string(columns) + " x " +
                                      std::to_string(rows) + " discs, pitch " + number(pitch),
                                  static_cast<double>(columns) * pitch, 1, 14);
    scene.setting.box_height = static_cast<double>(rows) * pitch;
    scene.setting.sync_every = 5;
    scene.setting.micro_steps = 2;
    Random random(seed);
    const double shake = 0.49 * (pitch - 2);
    for (std::size_t i = 0; i < columns * rows; ++i)
        add_disc(scene,
                 (static_cast<double>(i % columns) + 0.5) * pitch + random.uniform(-shake, shake),
                 (static_cast<double>(i / columns) + 0.5) * pitch + random.uniform(-shake, shake));
    set_speeds(scene, 2 * speed, random);
    return scene;
}

TestScene tube(std::size_t n, double height, double pitch, std::uint64_t seed) {
    TestScene scene = rectangle(n, 1, pitch, 0.3, seed);
    Random random(seed + 1);
    scene.name = "tube of height " + number(height);
    scene.setting.box_height = height;
    for (InputDisc& disc : scene.discs) disc.y = random.uniform(1, height - 1);
    return scene;
}

std::vector<Case> cases() {
    std::vector<Case> all;
    add_walled(all, rectangle(24, 7, 2.6, 0.3, 901));
    add_walled(all, rectangle(18, 5, 6, 1.1, 902));
    add_pairs(all, rectangle(20, 6, 2.7, 0.3, 903));
    add_bodies(all, rectangle(20, 8, 4, 0.4, 904));
    for (const TestScene& base :
         {rectangle(24, 4, 2.6, 0.3, 905), rectangle(30, 2, 2.3, 0.6, 906)}) {
        add(all, base, "periodic", {elastic, all_round, {}});
        add(all, base, "periodic along x", {elastic, along_x, {}});
        add(all, base, "periodic along y", {elastic, along_y, {}});
    }
    for (const double height : {2.2, 2.5, 3.9}) {
        const TestScene base = tube(40, height, 3, 907);
        add(all, base, "walls", {});
        add(all, base, "periodic along x", {elastic, along_x, {}});
    }
    add(all, tube(40, 4.001, 3, 908), "periodic", {elastic, all_round, {}});
    return all;
}

} // namespace carrom::test
