// SPDX-License-Identifier: BSD-3-Clause
#include "stored_scene/stored_scene.hpp"

#include <algorithm>
#include <sstream>

#include "core/errors.hpp"
#include "engine/engine.hpp"
#include "machine/machine.hpp"
#include "scene/compare.hpp"
#include "scene/disc_columns.hpp"
#include "scene/read_scene.hpp"

namespace carrom {

namespace {

/// The part of the header that does not change during the run.
CheckpointHeader run_of(const SceneParameters& scene) {
    CheckpointHeader header;
    header.program_version = version();
    header.scene_name = scene.name;
    header.scene_text = scene.text;
    for (const std::string& override : scene.overrides) header.scene_overrides += override + '\n';
    header.scene_lines_before_discs = scene.lines_before_discs;
    header.scene_discs_follow = scene.discs_follow ? 1 : 0;
    header.set_box(scene.box);
    header.radius = scene.radius;
    header.method = scene.method == Method::time_stepped ? "time-stepped" : "event-driven";
    header.micro_steps = scene.micro_steps;
    header.sync_every = scene.sync_every;
    header.n_discs = scene.n_discs;
    if (has_column(scene, DiscColumn::radius)) header.species = scene.effects.species;
    return header;
}

} // namespace

CheckpointHeader header_now(const SceneParameters& scene, const DiscSystem& system) {
    CheckpointHeader header = run_of(scene);
    header.step = system.step();
    header.micro_steps_done = system.micro_steps_done();
    header.frame = system.frame();
    header.set_box(system.engine().box());
    header.columns = side_columns_of(scene);
    header.shown = system_of(scene);
    if (header.box() != scene.box) header.shown.box = header.box();
    return header;
}

SceneParameters scene_of(const CheckpointHeader& header,
                         const std::vector<std::string>& more_overrides) {
    std::vector<std::string> overrides;
    std::istringstream lines(header.scene_overrides);
    for (std::string line; std::getline(lines, line);) overrides.push_back(line);
    overrides.insert(overrides.end(), more_overrides.begin(), more_overrides.end());
    SceneText text{header.scene_name,
                   header.scene_text,
                   header.scene_lines_before_discs,
                   header.scene_discs_follow != 0,
                   {}};
    if (!header.species.empty()) text.columns = DiscColumns{header.species, {}, true};
    SceneParameters scene = read_scene(text, overrides);
    if (has_column(scene, DiscColumn::radius) && !text.columns)
        throw InputError({{header.scene_name, 0,
                           "'discs.columns' names radii, and the checkpoint has none of them"}});
    return scene;
}

void refuse_other_run(const CheckpointHeader& header, const SceneParameters& scene,
                      const std::string& place) {
    const SceneParameters there = scene_of(header, {});
    std::vector<Problem> problems;
    for (const std::string& difference : physical_differences(there, scene))
        problems.push_back({place, 0, difference + "; a restart cannot change it"});
    if (header.columns != side_columns_of(there))
        problems.push_back({place, 0, "its scene and its columns of discs do not agree"});
    if (!problems.empty()) throw InputError(std::move(problems));
}

std::string first_difference(const CheckpointHeader& there, const SceneParameters& scene) {
    try {
        const std::vector<std::string> differences = physical_differences(scene_of(there, {}),
                                                                          scene);
        return differences.empty() ? "" : differences.front();
    } catch (const InputError&) {
        return "its scene cannot be read here";
    }
}

RecordedSystem system_of(const SceneParameters& scene) {
    RecordedSystem system;
    system.program_version = version();
    system.n_discs = scene.n_discs;
    const Extent end = extent_of_lines(scene.effects, scene.box, static_cast<double>(scene.steps));
    system.box = {std::max(scene.box.x, end.x_high), std::max(scene.box.y, end.y_high)};
    if (scene.box.is_square() && !scene.effects.are_periodic())
        system.box = system.box.longest(); // recorded as a square, even if walls move
    system.radius = scene.radius;
    system.species = scene.effects.species;
    system.is_periodic_x = scene.effects.is_periodic_x();
    system.is_periodic_y = scene.effects.is_periodic_y();
    for (std::size_t side = 0; side < system.open_boundaries.size(); ++side) {
        const Boundary& boundary = scene.effects.boundaries[side];
        system.open_boundaries[side] = boundary.kind == BoundaryKind::open;
        system.amplitudes[side] = boundary.amplitude;
    }
    system.origin = {scene.origin.x, scene.origin.y};
    system.length_unit = scene.length_unit;
    system.time_unit = scene.time_unit;
    return system;
}

TrajectoryLayout layout_of(const SceneParameters& scene, const TrajectoryOutput& wanted) {
    TrajectoryLayout layout;
    layout.system = system_of(scene);
    layout.run = run_of(scene);
    layout.velocity_unit = static_cast<double>(scene.micro_steps);
    layout.has_position = wanted.has_position;
    layout.has_velocity = wanted.has_velocity;
    layout.has_collisions = wanted.has_collisions;
    layout.has_image = wanted.has_image;
    layout.computed = wanted.computed;
    layout.columns = wanted.columns;
    layout.is_single = wanted.is_single;
    return layout;
}

} // namespace carrom
