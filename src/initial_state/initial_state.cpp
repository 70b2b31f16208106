// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/initial_state.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "dynamics/obstacles.hpp"
#include "initial_state/legacy_discs.hpp"
#include "initial_state/random_insertion.hpp"
#include "initial_state/velocities.hpp"
#include "lattices/lattice.hpp"
#include "lattices/triangular.hpp"
#include "parallel/agreement.hpp"
#include "parallel/exchange.hpp"
#include "parallel/slabs.hpp"
#include "scene/disc_reader.hpp"

namespace carrom {

namespace {

constexpr std::size_t chunk_size = std::size_t{1} << 16;

/// Sends rank 0's chunk to the ranks whose share of ids holds its discs. **Collective.**
void hand_out(const std::vector<InputDisc>& chunk, const SceneParameters& scene,
              const Communicator& communicator, std::vector<InputDisc>& discs) {
    std::vector<std::vector<InputDisc>> out(static_cast<std::size_t>(communicator.size()));
    for (const InputDisc& disc : chunk)
        out[static_cast<std::size_t>(slab_of(disc.id, scene.n_discs, communicator.size()))]
            .push_back(disc);
    const Received<InputDisc> in = send_to_owners(communicator, out);
    discs.insert(discs.end(), in.items.begin(), in.items.end());
}

DiscReader::InParts on_threads(int n_threads) {
    return [n_threads](std::size_t n, const auto& work) {
        const auto n_parts = static_cast<std::size_t>(n_threads);
#pragma omp parallel for num_threads(n_threads) schedule(static)
        for (std::size_t k = 0; k < n_parts; ++k) work(n * k / n_parts, n * (k + 1) / n_parts);
    };
}

std::vector<InputDisc> read_discs(const SceneParameters& scene, std::istream* lines,
                                  const Communicator& communicator, int n_threads) {
    std::vector<InputDisc> discs, chunk;
    std::vector<Problem> problems;
    if (communicator.is_root()) {
        ensure(lines != nullptr, "listed discs need a stream on rank 0");
        DiscReader reader(*lines, scene);
        for (bool has_more = true; has_more;) {
            has_more = reader.read(chunk, chunk_size, on_threads(n_threads));
            if (!communicator.any(has_more)) break;
            hand_out(chunk, scene, communicator, discs);
        }
        problems = reader.problems();
    } else {
        while (communicator.any(false)) hand_out(chunk, scene, communicator, discs);
    }
    agree_on_problems(communicator, problems);
    return discs;
}

/// The ids that this rank makes if places are functions of the id.
Slab share_of(const SceneParameters& scene, const Communicator& communicator) {
    return slab_of_rank(communicator.rank(), scene.n_discs, communicator.size());
}

std::vector<InputDisc> listed_discs(const SceneParameters& scene,
                                    const Communicator& communicator) {
    const auto [first, last] = share_of(scene, communicator);
    const auto begin = scene.listed_discs.begin();
    return {begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(last)};
}

/// A number coprime to n and near its golden section. Sites taken in such strides mix
/// species, which come in the order of ids.
std::uint64_t mixing_stride(std::uint64_t n) {
    auto stride = static_cast<std::uint64_t>(0.6180339887498949 * static_cast<double>(n)) | 1;
    while (std::gcd(stride, n) != 1) stride += 2;
    return stride;
}

/// Places one disc on each site; `place_of` gives the place of a site.
template <class PlaceOf>
std::vector<InputDisc> discs_on_sites(const SceneParameters& scene,
                                      const Communicator& communicator, const PlaceOf& place_of) {
    const auto [first, last] = share_of(scene, communicator);
    std::vector<InputDisc> discs;
    discs.reserve(last - first);
    const std::uint64_t stride = scene.effects.species.empty() ? 1 : mixing_stride(scene.n_discs);
    for (DiscId id = first; id < last; ++id) {
        const Point place = place_of(id * stride % scene.n_discs); // below 2^64: ids are below 2^32
        discs.push_back({id, place.x, place.y, 0, 0});
    }
    return discs;
}

std::vector<InputDisc> lattice_discs(const SceneParameters& scene,
                                     const Communicator& communicator) {
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

/// The generated discs with places, but without velocities.
std::vector<InputDisc> generated_discs(const SceneParameters& scene,
                                       const Communicator& communicator, int n_threads) {
    if (scene.generator == Generator::lattice) return lattice_discs(scene, communicator);
    if (scene.generator == Generator::triangular) return triangular_discs(scene, communicator);
    return insert_at_random(scene, communicator, n_threads);
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
    for (DiscId first = 0; first < scene.n_discs; first += chunk_size) {
        chunk.clear();
        if (communicator.is_root())
            for (DiscId id = first; id < std::min<DiscId>(first + chunk_size, scene.n_discs); ++id)
                chunk.push_back(legacy_disc(scene, random, id, places[id]));
        hand_out(chunk, scene, communicator, discs);
    }
    return discs;
}

/// Refuses listed discs that are not clear of all obstacles; the message names the
/// first few. **Collective.**
void refuse_in_obstacles(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                         const Communicator& communicator) {
    constexpr std::size_t most_named = 5;
    if (!scene.effects.obstacles.are_any()) return;
    const Obstacles obstacles(scene.box, scene.radius, scene.effects);
    const SpeciesTable species_table(scene.effects.species, scene.radius);
    const double least = 2 * std::max(2e-12 * scene.radius, 32 * 0x1p-53 * scene.box.longest());
    std::vector<Problem> problems;
    for (const InputDisc& disc : discs) {
        const auto overlap = obstacles.deepest_overlap(disc.x, disc.y,
                                                       species_table.of(disc.id).radius, least);
        if (overlap.body == ObstacleContact::no_body || problems.size() == most_named) continue;
        problems.push_back(
            {scene.name, 0,
             fmt::format("disc {} at ({}, {}) overlaps {} by {:.3g}; move one of them", disc.id,
                         disc.x, disc.y, obstacles.name_of(overlap.body), overlap.depth)});
    }
    agree_on_problems(communicator, problems);
}

} // namespace

std::vector<InputDisc> initial_state(const SceneParameters& scene, std::istream* lines,
                                     const Communicator& communicator, int n_threads) {
    if (scene.generator == Generator::file) {
        std::vector<InputDisc> listed = scene.reads_disc_lines()
                                            ? read_discs(scene, lines, communicator, n_threads)
                                            : listed_discs(scene, communicator);
        refuse_in_obstacles(scene, listed, communicator);
        return listed;
    }
    ensure(scene.generator != Generator::compressed, "a compressed start takes an engine");
    std::vector<InputDisc> discs;
    if (scene.generator == Generator::legacy) {
        discs = legacy_discs(scene, communicator);
        add_streams(scene, discs);
    } else {
        discs = generated_discs(scene, communicator, n_threads);
        give_velocities(scene, discs, communicator);
    }
    return discs;
}

} // namespace carrom
