// SPDX-License-Identifier: BSD-3-Clause
#include "apps/failure_scene.hpp"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "apps/report_file.hpp"

namespace carrom {

namespace {

/// The scene's keys of effects, those that are not as they are by default.
std::string effects_text(const Effects& effects) {
    std::string text;
    for (std::size_t k = 0; k < effects.boundaries.size(); ++k) {
        const Boundary& side = effects.boundaries[k];
        if (side.is_plain()) continue;
        text += fmt::format("[box.{}]\n", boundary_names[k]);
        if (side.kind == BoundaryKind::periodic) text += "kind = \"periodic\"\n";
        if (side.kind == BoundaryKind::thermal)
            text += fmt::format("kind = \"thermal\"\ntemperature = {}\n", side.temperature);
        if (side.kind == BoundaryKind::moving)
            text += fmt::format(
                "kind = \"moving\"\nspeed = {} # and it has moved since the scene's start\n",
                side.speed);
        if (side.restitution != 1) text += fmt::format("restitution = {}\n", side.restitution);
    }
    if (effects.obstacles.are_any()) {
        text += fmt::format("[effects.obstacles]\nrestitution = {}\ndiscs = [",
                            effects.obstacles.restitution);
        for (const FixedDisc& disc : effects.obstacles.discs)
            text += fmt::format("[{}, {}, {}], ", disc.x, disc.y, disc.radius);
        text += "]\nsegments = [";
        for (const Segment& segment : effects.obstacles.segments)
            text += fmt::format("[{}, {}, {}, {}], ", segment.x0, segment.y0, segment.x1,
                                segment.y1);
        text += "]\n";
    }
    if (effects.gravity.is_any())
        text += fmt::format("[effects.gravity]\nx = {}\ny = {}\n", effects.gravity.x,
                            effects.gravity.y);
    if (effects.drag != 0) text += fmt::format("[effects.drag]\nrate = {}\n", effects.drag);
    if (effects.contact.kind == ContactKind::none) text += "[effects.contact]\nkind = \"none\"\n";
    if (effects.contact.kind == ContactKind::restitution)
        text += fmt::format(
            "[effects.contact]\nkind = \"restitution\"\nrestitution = {}\ncontact_time = {}\n",
            effects.contact.restitution, effects.contact.contact_time);
    if (const ContactEffect& contact = effects.contact; contact.kind == ContactKind::rough) {
        text += fmt::format("[effects.contact]\nkind = \"rough\"\nrestitution = {}\ncontact_time = "
                            "{}\ntangential_restitution = {}\nmoment_of_inertia = {}\n",
                            contact.restitution, contact.contact_time,
                            contact.tangential_restitution, contact.inertia);
        if (std::isfinite(contact.friction))
            text += fmt::format("friction = {}\n", contact.friction);
    }
    return text;
}

std::string scene_text(const Scene& scene, const CheckFailure& failure,
                       const std::string& discs_file) {
    std::string text = fmt::format("# {}\n# Discs as they were at step {}; their ids in {}:",
                                   failure.what(), failure.step - 1, scene.name);
    for (std::size_t i = 0; i < failure.discs_around.size(); ++i)
        text += fmt::format(" {} was {};", i, failure.discs_around[i].id);
    text.back() = '.';
    const bool are_mixed = !scene.effects.species.empty(), do_turn = !failure.spins.empty();
    std::string sizes = are_mixed ? "columns = [\"radius\", \"mass\""
                                  : fmt::format("radius = {}\n", scene.radius);
    if (do_turn)
        sizes += are_mixed ? ", \"spin\"]\n" : "columns = [\"spin\"]\n";
    else if (are_mixed)
        sizes += "]\n";
    return text +
           fmt::format(
               "\n[box]\nsize = {}\n[discs]\n{}count = {}\nfile = \"{}\"\n"
               "[time]\nsteps = 1\nmicro_steps = {}\nsync_every = {}\ncollisions = \"{}\"\n",
               scene.box_size, sizes, failure.discs_around.size(), discs_file, scene.micro_steps,
               scene.sync_every,
               scene.method == Method::time_stepped ? "time-stepped" : "event-driven") +
           effects_text(scene.effects);
}

std::string disc_lines(const Scene& scene, const CheckFailure& failure) {
    const SpeciesTable species_table(scene.effects.species, scene.radius);
    const std::vector<InputDisc>& discs = failure.discs_around;
    std::string text;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        text += fmt::format("{} {} {} {} {}", i, discs[i].x, discs[i].y, discs[i].vx, discs[i].vy);
        if (const Body& body = species_table.of(discs[i].id); !scene.effects.species.empty())
            text += fmt::format(" {} {}", body.radius, body.mass);
        text += failure.spins.empty() ? "\n" : fmt::format(" {}\n", failure.spins[i]);
    }
    return text;
}

} // namespace

std::string write_failure_scene(const std::string& folder, const Scene& scene,
                                const CheckFailure& failure) {
    if (failure.discs_around.empty()) return "there are no discs around it to show";
    const std::string name = fmt::format("check_step_{}_disc_{}", failure.step, failure.disc);
    const std::string scene_path = (std::filesystem::path(folder) / (name + ".toml")).string();
    std::string obstacle = write_whole_file(
        (std::filesystem::path(folder) / (name + ".discs")).string(), disc_lines(scene, failure));
    if (obstacle.empty())
        obstacle = write_whole_file(scene_path, scene_text(scene, failure, name + ".discs"));
    if (!obstacle.empty()) return "the discs around it could not be written: " + obstacle;
    return fmt::format("{} discs around it, from the step before, are in {}",
                       failure.discs_around.size(), scene_path);
}

CollectiveError reported(const CheckFailure& failure, const Scene& scene,
                         const Communicator& ranks) {
    std::string sentence;
    if (ranks.is_root()) sentence = write_failure_scene("", scene, failure);
    ranks.broadcast(sentence);
    return CollectiveError(fmt::format("{}\n{}", failure.what(), sentence), failure.code());
}

void advance_or_report(Simulation& simulation, std::int64_t last_step, const Scene& scene,
                       const Communicator& ranks) {
    try {
        simulation.advance_towards(last_step);
    } catch (const CheckFailure& failure) {
        throw reported(failure, scene, ranks);
    }
}

} // namespace carrom
