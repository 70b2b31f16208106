// SPDX-License-Identifier: BSD-3-Clause
#include "regressions.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "runs.hpp"
#include "scene/read_scene.hpp"
#include "scene_tools.hpp"
#include "troubled_effects.hpp"

namespace carrom::test {

namespace {

using Fails = std::function<bool(const TestScene&)>;

/// Calls `change(scene)` on a copy and keeps it if it still fails.
template <class Change>
bool keep_if_it_fails(TestScene& scene, const Fails& fails, const Change& change) {
    TestScene trial = scene;
    change(trial);
    if (!fails(trial)) return false;
    scene = trial;
    return true;
}

/// Removes one disc; the largest radius is that of the remaining ones.
void leave_out_species(reference::Setting& setting, DiscId departed) {
    std::vector<Species>& species = setting.effects.species;
    if (species.empty()) return;
    auto its = species.begin();
    while (departed >= its->count) departed -= (its++)->count;
    if (--its->count == 0) species.erase(its);
    setting.radius = 0;
    for (const Species& one : species) setting.radius = std::max(setting.radius, one.radius);
}

void leave_out(TestScene& scene, std::size_t place) {
    const DiscId departed = scene.discs[place].id;
    scene.discs.erase(scene.discs.begin() + static_cast<std::ptrdiff_t>(place));
    for (InputDisc& disc : scene.discs) disc.id -= disc.id > departed;
    leave_out_species(scene.setting, departed);
    std::vector<double>& spins = scene.setting.first_spins;
    if (!spins.empty()) spins.erase(spins.begin() + static_cast<std::ptrdiff_t>(departed));
}

/// Removes or simplifies each effect, one at a time. A change without effect on the scene is no
/// success.
bool shrink_effects(TestScene& scene, const Fails& fails) {
    bool has_changed = false;
    const auto without = [&](const auto& change) {
        TestScene trial = scene;
        change(trial.setting);
        if (trial.setting.effects == scene.setting.effects &&
            trial.setting.first_spins == scene.setting.first_spins)
            return;
        hand_to_reference(trial.setting);
        has_changed |= keep_if_it_fails(scene, fails, [&trial](TestScene& copy) { copy = trial; });
    };
    const FixedBodyList& obstacles = scene.setting.effects.fixed_bodies;
    const auto nth = [](auto& list, std::size_t i) {
        return list.begin() + static_cast<std::ptrdiff_t>(i);
    };
    for (std::size_t i = obstacles.discs.size(); i-- > 0;)
        without([&](reference::Setting& s) {
            s.effects.fixed_bodies.discs.erase(nth(s.effects.fixed_bodies.discs, i));
        });
    for (std::size_t i = obstacles.segments.size(); i-- > 0;)
        without([&](reference::Setting& s) {
            s.effects.fixed_bodies.segments.erase(nth(s.effects.fixed_bodies.segments, i));
        });
    without([](reference::Setting& s) { s.effects.fixed_bodies.restitution = 1; });
    for (const std::size_t low : {0u, 2u}) {
        without([low](reference::Setting& s) {
            s.effects.boundaries[low] = s.effects.boundaries[low + 1] = {};
        });
        if (scene.setting.effects.boundaries[low].kind == BoundaryKind::periodic) continue;
        for (const std::size_t side : {low, low + 1})
            without([side](reference::Setting& s) { s.effects.boundaries[side] = {}; });
    }
    without([](reference::Setting& s) { s.effects.gravity = {}; });
    without([](reference::Setting& s) { s.effects.drag = 0; });
    without([](reference::Setting& s) { s.effects.contact = {}, s.first_spins.clear(); });
    without([](reference::Setting& s) { s.first_spins.clear(); });
    without([](reference::Setting& s) {
        for (Species& one : s.effects.species) one.mass = 1;
    });
    return has_changed;
}

/// Writes effects key by key, and the method.
std::string toml_of(const Effects& effects, Method method) {
    std::string text = fmt::format("method = \"{}\"\n", name_of(method));
    bool is_lossy = effects.gravity.is_on() || effects.fixed_bodies.restitution < 1;
    for (std::size_t k = 0; k < boundary_names.size(); ++k) {
        const Boundary& side = effects.boundaries[k];
        is_lossy = is_lossy || side.restitution < 1 || side.kind == BoundaryKind::oscillating ||
                   (effects.drag > 0 && side.speed != 0);
        if (side.is_plain()) continue;
        text += fmt::format("[box.{}]\n", boundary_names[k]);
        switch (side.kind) {
        case BoundaryKind::thermal:
            text += fmt::format("kind = \"thermal\"\ntemperature = {:.17g}\n", side.temperature);
            break;
        case BoundaryKind::moving:
            text += fmt::format("kind = \"moving\"\nspeed = {:.17g}\n", side.speed);
            break;
        case BoundaryKind::oscillating:
            text += fmt::format("kind = \"oscillating\"\namplitude = {:.17g}\n"
                                "period = {:.17g}\nphase = {:.17g}\n",
                                side.amplitude, side.period, side.phase);
            break;
        case BoundaryKind::open: text += "kind = \"open\"\n"; break;
        case BoundaryKind::periodic: text += "kind = \"periodic\"\n"; break;
        case BoundaryKind::sheared: text += "kind = \"sheared\"\n"; break; // no test draws one
        case BoundaryKind::wall: break;
        }
        if (side.restitution < 1) text += fmt::format("restitution = {:.17g}\n", side.restitution);
    }
    const ContactEffect& contact = effects.contact;
    const bool is_rough = contact.kind == ContactKind::rough,
               is_dull = is_rough || contact.kind == ContactKind::restitution;
    if (contact.kind != ContactKind::elastic || is_lossy) text += "[effects.contact]\n";
    if (contact.kind == ContactKind::none) text += "kind = \"none\"\n";
    if (is_dull)
        text += fmt::format("kind = \"{}\"\nrestitution = {:.17g}\n",
                            is_rough ? "rough" : "restitution", contact.restitution);
    if (is_rough)
        text += fmt::format("tangential_restitution = {:.17g}\nmoment_of_inertia = {:.17g}\n",
                            contact.tangential_restitution, contact.inertia);
    if (is_rough && std::isfinite(contact.friction))
        text += fmt::format("friction = {:.17g}\n", contact.friction);
    if ((is_dull || is_lossy) && contact.contact_time > 0)
        text += fmt::format("contact_time = {:.17g}\n", contact.contact_time);
    if (effects.gravity.is_on())
        text += fmt::format("[effects.gravity]\nx = {:.17g}\ny = {:.17g}\n", effects.gravity.x,
                            effects.gravity.y);
    if (effects.drag > 0) text += fmt::format("[effects.drag]\nrate = {:.17g}\n", effects.drag);
    const bool is_thermal = std::any_of(
        effects.boundaries.begin(), effects.boundaries.end(),
        [](const Boundary& side) { return side.kind == BoundaryKind::thermal; });
    if (is_thermal) text += fmt::format("[effects.thermal]\nseed = {}\n", effects.thermal_seed);
    if (!effects.fixed_bodies.are_any()) return text;
    text += "[effects.obstacles]\ndiscs = [\n";
    for (const FixedDisc& disc : effects.fixed_bodies.discs)
        text += fmt::format("  [{:.17g}, {:.17g}, {:.17g}],\n", disc.x, disc.y, disc.radius);
    text += "]\nsegments = [\n";
    for (const Segment& s : effects.fixed_bodies.segments)
        text += fmt::format("  [{:.17g}, {:.17g}, {:.17g}, {:.17g}],\n", s.x0, s.y0, s.x1, s.y1);
    return text + fmt::format("]\nrestitution = {:.17g}\n", effects.fixed_bodies.restitution);
}

} // namespace

TestScene shrunk(TestScene scene, const Fails& fails) {
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (std::size_t i = scene.discs.size(); i-- > 0 && scene.discs.size() > 1;)
            has_changed |= keep_if_it_fails(scene, fails,
                                            [i](TestScene& trial) { leave_out(trial, i); });
        while (scene.steps > 1 &&
               keep_if_it_fails(scene, fails, [](TestScene& trial) { trial.steps -= 1; }))
            has_changed = true;
        has_changed |= shrink_effects(scene, fails);
        for (InputDisc& disc : scene.discs) {
            for (double InputDisc::* const number :
                 {&InputDisc::vx, &InputDisc::vy, &InputDisc::x, &InputDisc::y}) {
                const double unit = scene.setting.radius / 16,
                             rounded = std::round(disc.*number / unit) * unit;
                const bool is_place = number == &InputDisc::x || number == &InputDisc::y;
                if (rounded == disc.*number) continue;
                if (is_place && !(rounded >= scene.setting.radius &&
                                  rounded <= scene.setting.box_size - scene.setting.radius))
                    continue;
                const auto place = &disc - scene.discs.data();
                has_changed |= keep_if_it_fails(scene, fails, [&](TestScene& trial) {
                    trial.discs[static_cast<std::size_t>(place)].*number = rounded;
                });
            }
        }
    }
    return scene;
}

std::string toml_of(const TestScene& scene, Method method) {
    const reference::Setting& setting = scene.setting;
    std::vector<InputDisc> discs = scene.discs;
    std::sort(discs.begin(), discs.end(),
              [](const InputDisc& a, const InputDisc& b) { return a.id < b.id; });
    std::string rows;
    for (const InputDisc& disc : discs) {
        rows += fmt::format("  [{:.17g}, {:.17g}, {:.17g}, {:.17g}", disc.x, disc.y, disc.vx,
                            disc.vy);
        if (!setting.effects.species.empty())
            rows += fmt::format(", {:.17g}, {:.17g}", setting.radius_of(disc.id),
                                setting.mass_of(disc.id));
        if (!setting.first_spins.empty())
            rows += fmt::format(", {:.17g}", setting.first_spins[disc.id]);
        rows += "],\n";
    }
    const std::string radius = setting.effects.species.empty()
                                   ? fmt::format("radius = {:.17g}\n", setting.radius)
                                   : "";
    return fmt::format("[box]\nsize = {:.17g}\n[discs]\n{}list = [\n{}]\n[time]\nsteps = "
                       "{}\nmicro_steps = {}\nsync_every = {}\n{}",
                       setting.box_size, radius, rows, scene.steps, setting.micro_steps,
                       setting.sync_every,
                       setting.effects.are_any() ? toml_of(setting.effects, method) : "");
}

Regression regression_of(const std::string& text, const std::string& name) {
    const SceneParameters read = read_scene(text, name);
    TestScene scene = empty_scene(name, read.box.x, read.radius, read.steps);
    scene.setting.micro_steps = read.micro_steps;
    scene.setting.sync_every = read.sync_every;
    scene.setting.effects = read.effects;
    scene.discs = read.listed_discs;
    const bool has_spins = !read.first_numbers[SideColumn::spin].empty();
    for (std::size_t id = 0; id < scene.discs.size() && has_spins; ++id)
        scene.setting.first_spins.push_back(first_number(read, SideColumn::spin, id));
    if (!read.effects.are_any()) return {scene, {Method::time_stepped, Method::event_driven}};
    hand_to_reference(scene.setting);
    return {scene, {read.method}};
}

Regression read_regression(const std::string& path) {
    std::ifstream file(path);
    return regression_of({std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()},
                         path);
}

} // namespace carrom::test
