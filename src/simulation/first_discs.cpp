// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/first_discs.hpp"

#include <cmath>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "initial_state/freeze_discs.hpp"
#include "initial_state/initial_state.hpp"
#include "initial_state/random_insertion.hpp"
#include "initial_state/scene_input.hpp"
#include "scene/disc_groups.hpp"
#include "simulation/compression.hpp"

namespace carrom {

namespace {

/// A scene that contains only this group and has the group's region as its box. `number` is the
/// group's number, so that equal groups get different random numbers. A region as long as a period
/// is periodic as well.
SceneParameters scene_of_group(const SceneParameters& scene, const DiscGroup& group, double radius,
                               std::uint64_t number) {
    const StartRegion region = region_of(scene, group);
    SceneParameters alone;
    alone.name = fmt::format("{}: the group in [{:g}, {:g}, {:g}, {:g}]", scene.name, region.x_low,
                             region.y_low, region.x_high, region.y_high);
    alone.box = Box(region.x_high - region.x_low, region.y_high - region.y_low);
    alone.n_discs = group.count;
    alone.radius = radius;
    alone.generator = group.generator;
    alone.compression_rate = scene.compression_rate;
    alone.seed = scene.seed + number;
    for (std::size_t side = 0; side < boundary_names.size(); ++side) {
        const bool is_whole = side < 2 ? alone.box.x == scene.box.x : alone.box.y == scene.box.y;
        if (is_whole && scene.effects.boundaries[side].is_periodic())
            alone.effects.boundaries[side].kind = BoundaryKind::periodic;
    }
    return alone;
}

/// The ids and positions of the discs of a group whose generator is not random. **Collective.**
std::vector<InputDisc> places_of(const SceneParameters& scene, const DiscGroup& group, DiscId first,
                                 std::uint64_t number, const Communicator& communicator,
                                 const Tuning& tuning) {
    const double radius = SpeciesTable(scene.effects.species, scene.radius).of(first).radius;
    const SceneParameters alone = scene_of_group(scene, group, radius, number);
    std::vector<InputDisc> discs = group.generator == Generator::compressed
                                       ? compressed_places(alone, communicator, tuning)
                                       : generated_places(alone, communicator, tuning.threads);
    const StartRegion region = region_of(scene, group);
    for (InputDisc& disc : discs) {
        if (alone.effects.is_periodic_x()) disc.x -= alone.box.x * std::floor(disc.x / alone.box.x);
        if (alone.effects.is_periodic_y()) disc.y -= alone.box.y * std::floor(disc.y / alone.box.y);
        disc = {disc.id + first, disc.x + region.x_low, disc.y + region.y_low, 0, 0};
    }
    return discs;
}

std::vector<InputDisc> places_of_groups(const SceneParameters& scene,
                                        const Communicator& communicator, const Tuning& tuning) {
    std::vector<InputDisc> given;
    DiscId first = 0;
    std::uint64_t number = 0;
    for (const DiscGroup& group : scene.groups) {
        if (group.generator != Generator::random) {
            const std::vector<InputDisc> places = places_of(scene, group, first, number,
                                                            communicator, tuning);
            given.insert(given.end(), places.begin(), places.end());
        }
        first += group.count;
        number += 1;
    }
    refuse_in_fixed_bodies(scene, given, communicator);
    return insert_at_random(scene, communicator, tuning.threads, given);
}

std::vector<InputDisc> first_places(const SceneParameters& scene, std::istream* following,
                                    const Communicator& communicator, const Tuning& tuning) {
    if (!scene.groups.empty()) return places_of_groups(scene, communicator, tuning);
    if (scene.generator == Generator::compressed)
        return compressed_places(scene, communicator, tuning);
    return load_places(scene, following, communicator, tuning.threads);
}

} // namespace

std::vector<InputDisc> first_discs(const SceneParameters& scene, std::istream* following,
                                   const Communicator& communicator, const Tuning& tuning) {
    ensure(!scene.freezes(), "discs that freeze change the scene");
    std::vector<InputDisc> discs = first_places(scene, following, communicator, tuning);
    give_first_velocities(scene, discs, communicator, tuning.threads);
    return discs;
}

std::vector<InputDisc> first_discs_and_frozen(SceneParameters& scene, std::istream* following,
                                              const Communicator& communicator,
                                              const Tuning& tuning) {
    if (!scene.frozen.empty())
        throw InputError({{scene.name, 0,
                           "'discs.frozen' is written by the program for checkpoints; leave it "
                           "out, and discs freeze by 'discs.freeze' or groups"}});
    std::vector<InputDisc> discs = first_places(scene, following, communicator, tuning);
    if (scene.awaits_frozen()) freeze_discs(scene, discs, communicator);
    give_first_velocities(scene, discs, communicator, tuning.threads);
    return discs;
}

} // namespace carrom
