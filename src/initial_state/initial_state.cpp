// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/initial_state.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/useful_threads.hpp"
#include "dynamics/fixed_bodies.hpp"
#include "initial_state/lattice_around.hpp"
#include "initial_state/legacy_discs.hpp"
#include "initial_state/listed_discs.hpp"
#include "initial_state/random_insertion.hpp"
#include "initial_state/velocities.hpp"
#include "lattices/lattice.hpp"
#include "lattices/triangular.hpp"
#include "parallel/agreement.hpp"
#include "scene/places.hpp"

namespace carrom {

namespace {

std::vector<InputDisc> listed_discs(const SceneParameters& scene,
                                    const Communicator& communicator) {
    const auto [first, last] = share_of(scene, communicator);
    const auto begin = scene.listed_discs.begin();
    return {begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(last)};
}

/// Places one disc on each site; `place_of` returns the position of a site.
template <class PlaceOf>
std::vector<InputDisc> discs_on_sites(const SceneParameters& scene,
                                      const Communicator& communicator, const PlaceOf& place_of) {
    const auto [first, last] = share_of(scene, communicator);
    std::vector<InputDisc> discs;
    discs.reserve(last - first);
    const std::uint64_t stride = scene.effects.species.empty() ? 1 : mixing_stride(scene.n_discs);
    for (DiscId id = first; id < last; ++id) {
        // The product cannot overflow 64 bits, because both factors are below 2^32
        const Point place = place_of(id * stride % scene.n_discs);
        discs.push_back({id, place.x, place.y, 0, 0});
    }
    return discs;
}

std::vector<InputDisc> lattice_discs(const SceneParameters& scene,
                                     const Communicator& communicator) {
    if (scene.effects.fixed_bodies.are_any())
        return lattice_around_fixed_bodies(scene, communicator);
    const auto lattice = widest_lattice(scene.n_discs, scene.box, scene.radius);
    ensure(lattice.has_value(), "the scene was checked, yet its lattice does not fit");
    return discs_on_sites(scene, communicator, [&](std::uint64_t site) {
        return shaken_site(*lattice, site, scene.seed);
    });
}

std::vector<InputDisc> triangular_discs(const SceneParameters& scene,
                                        const Communicator& communicator) {
    const auto lattice = triangular_lattice(scene.n_discs, scene.box);
    ensure(lattice.has_value(), "the scene was checked, yet its triangular lattice does not fit");
    return discs_on_sites(scene, communicator,
                          [&](std::uint64_t site) { return lattice->site(site); });
}

std::vector<InputDisc> legacy_discs(const SceneParameters& scene,
                                    const Communicator& communicator) {
    LegacyRandom random(static_cast<unsigned>(scene.seed));
    std::vector<Point> places;
    std::vector<Problem> problems;
    if (communicator.is_root()) {
        if (auto found = legacy_positions(scene, random))
            places = std::move(*found);
        else
            problems.push_back(
                {scene.name, 0,
                 fmt::format("the box is too full for the legacy generator: it draws "
                             "places for {} discs (packing {:.4g}) and finds none free",
                             scene.n_discs, scene.packing())});
    }
    agree_on_problems(communicator, problems);
    std::vector<InputDisc> discs, chunk;
    for (DiscId first = 0; first < scene.n_discs; first += discs_at_once) {
        chunk.clear();
        if (communicator.is_root())
            for (DiscId id = first; id < std::min<DiscId>(first + discs_at_once, scene.n_discs);
                 ++id)
                chunk.push_back(legacy_disc(scene, random, id, places[id]));
        hand_out(chunk, scene, communicator, discs);
    }
    return discs;
}

} // namespace

std::vector<InputDisc> generated_places(const SceneParameters& scene,
                                        const Communicator& communicator, int n_threads) {
    if (scene.generator == Generator::lattice) return lattice_discs(scene, communicator);
    if (scene.generator == Generator::triangular) return triangular_discs(scene, communicator);
    // Limits the number of threads, because insertion has hundreds of short parallel regions, and
    // all threads have to wake for each of them.
    const std::uint64_t own = scene.n_discs / static_cast<std::uint64_t>(communicator.size());
    return insert_at_random(scene, communicator, useful_threads(n_threads, own));
}

void refuse_in_fixed_bodies(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                            const Communicator& communicator) {
    const std::size_t most_named = scene.groups.empty() ? 5 : 1; // one is enough to find the group
    const FixedBodies fixed_bodies(scene.box, scene.radius, scene.effects);
    if (!fixed_bodies.are_any()) return;
    const SpeciesTable species_table(scene.effects.species, scene.radius);
    const double least = 2 * std::max(2e-12 * scene.radius, 32 * 0x1p-53 * scene.box.longest());
    const char* const remedy =
        scene.groups.empty() ? "move one of them"
                             : "lattices and compressed discs of groups do not go around it; give "
                               "their group a region beside it, or take generator = \"random\"";
    std::vector<Problem> problems;
    for (const InputDisc& disc : discs) {
        const auto overlap = fixed_bodies.deepest_overlap(disc.x, disc.y,
                                                          species_table.of(disc.id).radius, least);
        if (overlap.body == BodyContact::no_body || problems.size() == most_named) continue;
        problems.push_back(
            {scene.name, 0,
             fmt::format("disc {} at {} overlaps {} by {:.3g}; {}", disc.id,
                         shown_place(scene, disc.x, disc.y), fixed_bodies.name_of(overlap.body),
                         overlap.depth, remedy)});
    }
    agree_on_problems(communicator, problems);
}

std::vector<InputDisc> initial_places(const SceneParameters& scene, std::istream* lines,
                                      const Communicator& communicator, int n_threads) {
    if (scene.generator == Generator::file) {
        std::vector<InputDisc> listed = scene.reads_disc_lines()
                                            ? read_listed_discs(scene, lines, communicator,
                                                                n_threads)
                                            : listed_discs(scene, communicator);
        refuse_in_fixed_bodies(scene, listed, communicator);
        return listed;
    }
    ensure(scene.generator != Generator::compressed && scene.groups.empty(),
           "a compressed start and groups take an engine");
    if (scene.generator == Generator::legacy) return legacy_discs(scene, communicator);
    return generated_places(scene, communicator, n_threads);
}

void give_first_velocities(const SceneParameters& scene, std::vector<InputDisc>& discs,
                           const Communicator& communicator, int n_threads) {
    if (scene.generator == Generator::legacy) return add_streams(scene, discs);
    if (scene.generator != Generator::file || scene.draws_velocities)
        give_velocities(scene, discs, communicator, n_threads);
    if (scene.velocities == VelocityKind::reversed)
        for (InputDisc& disc : discs) disc.vx = -disc.vx, disc.vy = -disc.vy;
}

std::vector<InputDisc> initial_state(const SceneParameters& scene, std::istream* lines,
                                     const Communicator& communicator, int n_threads) {
    std::vector<InputDisc> discs = initial_places(scene, lines, communicator, n_threads);
    give_first_velocities(scene, discs, communicator, n_threads);
    return discs;
}

} // namespace carrom
