// SPDX-License-Identifier: BSD-3-Clause
// Fills arrays with values of all discs (positions, velocities, spins and so on) for programs that
// work on arrays. Threads fill them without sorting, because a disc's index in an array is its id.
#include <bit>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "library/live_part.hpp"
#include "library/simulation_state.hpp"
#include "parallel/meeting.hpp"

namespace carrom {

namespace {

/// With fewer discs on a rank than this, waking the threads takes longer than a pass on one thread.
constexpr std::int64_t least_for_threads = 32768;

void check_size(const char* call, std::size_t size, std::uint64_t wanted) {
    if (size != wanted)
        throw InputError(
            {{call, 0, fmt::format("has room for {} numbers; it wants {}", size, wanted)}});
}

/// x and y, in one register: most of the time of `read_positions` is arithmetic.
using Pair [[gnu::vector_size(16)]] = double;
using PairOfWords [[gnu::vector_size(16)]] = std::int64_t;

[[gnu::always_inline]] inline Pair place_at(const DiscState& disc, double time) {
    return Pair{disc.x, disc.y} + Pair{disc.vx, disc.vy} * (time - disc.tau);
}

/// Puts the position in the box of a disc that may be outside. Not inlined, so that the loop over
/// all discs is short.
template <class Put>
[[gnu::noinline]] void put_from_outside(const Frame& frame, const DiscState& stored, double time,
                                        const Put& put) {
    const DiscState disc = frame.in_box(stored, time);
    put(disc.id, Pair{disc.x, disc.y});
}

/// Calls `put(id, place)` for each disc of this rank, on all threads if there are many discs. In a
/// moving frame it calls `put` a second time, with the right position, for a disc that may have
/// crossed a periodic side or has departed. So `put` must overwrite earlier values.
template <class Put> void for_each_place(const Run& run, const Put& put) {
    const DiscSystem& system = run.system();
    const std::span<const DiscState> discs = system.discs();
    const Frame frame = system.frame();
    const double time = system.clock();
    const auto n = static_cast<std::int64_t>(discs.size());
#pragma omp parallel num_threads(run.n_threads()) if (n >= least_for_threads)
    if (frame.is_moving) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        const Periods& periods = frame.periods;
        const Pair moved = {frame.x, frame.y}, high = {periods.x == 0 ? infinity : periods.x,
                                                       periods.y == 0 ? infinity : periods.y};
#pragma omp for schedule(static)
        for (std::int64_t i = 0; i < n; ++i) {
            const DiscState& disc = discs[static_cast<std::size_t>(i)];
            const Pair place = place_at(disc, time) + moved;
            put(disc.id, place);
            // In the box, coordinates are >= 0, and their differences from the upper sides are < 0.
            const auto signs = std::bit_cast<PairOfWords>(place) |
                               ~std::bit_cast<PairOfWords>(place - high);
            if ((signs[0] | signs[1]) < 0 || disc.has_departed()) [[unlikely]]
                put_from_outside(frame, disc, time, put);
        }
    } else {
#pragma omp for schedule(static)
        for (std::int64_t i = 0; i < n; ++i) {
            const DiscState& disc = discs[static_cast<std::size_t>(i)];
            put(disc.id, place_at(disc, time));
        }
    }
}

/// Calls `put(disc, i)` for each disc i of this rank, in the frame of the box, on all threads if
/// there are many discs.
template <class Put> void for_each_shown(const Run& run, const Put& put) {
    const DiscSystem& system = run.system();
    const std::span<const DiscState> discs = system.discs();
    const Frame frame = system.frame();
    const double time = system.clock();
    const auto n = static_cast<std::int64_t>(discs.size());
#pragma omp parallel for schedule(static) num_threads(run.n_threads()) if (n >= least_for_threads)
    for (std::int64_t i = 0; i < n; ++i) {
        const auto place = static_cast<std::size_t>(i);
        put(frame.in_box(discs[place], time), place);
    }
}

} // namespace

void Simulation::read_positions(std::span<double> xy) const {
    check_size("read_positions", xy.size(), 2 * scene().n_discs);
    const Origin& origin = live().run().scene().origin;
    const Pair corner = {origin.x, origin.y};
    for_each_place(live().run(), [&](DiscId id, Pair place) {
        place -= corner;
        xy[2 * id] = place[0];
        xy[2 * id + 1] = place[1];
    });
}

void Simulation::read_velocities(std::span<double> xy) const {
    check_size("read_velocities", xy.size(), 2 * scene().n_discs);
    const double unit = live().run().system().velocity_unit();
    for_each_shown(live().run(), [&](const DiscState& disc, std::size_t) {
        xy[2 * disc.id] = disc.vx * unit;
        xy[2 * disc.id + 1] = disc.vy * unit;
    });
}

void Simulation::read_spins(std::span<double> spins) const {
    check_size("read_spins", spins.size(), scene().n_discs);
    const DiscSystem& system = live().run().system();
    const double unit = system.velocity_unit();
    const std::span<const double> values = system.spins();
    for_each_shown(live().run(), [&](const DiscState& disc, std::size_t i) {
        spins[disc.id] = values.empty() ? 0 : values[i] * unit;
    });
}

void Simulation::read_directions(std::span<double> angles) const {
    check_size("read_directions", angles.size(), scene().n_discs);
    const SideSpans columns = live().run().system().side_columns();
    const std::span<const double> values = columns[SideColumn::direction];
    for_each_shown(live().run(), [&](const DiscState& disc, std::size_t i) {
        angles[disc.id] = values.empty() ? 0 : values[i];
    });
}

void Simulation::read_collisions(std::span<std::int64_t> counts) const {
    check_size("read_collisions", counts.size(), 2 * scene().n_discs);
    for_each_shown(live().run(), [&](const DiscState& disc, std::size_t) {
        counts[2 * disc.id] = static_cast<std::int64_t>(disc.wall_collisions);
        counts[2 * disc.id + 1] = static_cast<std::int64_t>(disc.pair_collisions);
    });
}

void Simulation::read_images(std::span<std::int32_t> lengths) const {
    check_size("read_images", lengths.size(), 2 * scene().n_discs);
    Run& run = live().run();
    if (run.scene().effects.are_sheared())
        throw InputError({{"read_images", 0,
                           "between sheared sides images move: whole numbers do not say where "
                           "they are"}});
    meet(run.ranks(), "Simulation::read_images");
    if (!run.images()) return;
    for (const DiscImage& image : run.images()->now()) {
        lengths[2 * image.id] = image.x;
        lengths[2 * image.id + 1] = image.y;
    }
}

std::vector<DiscKind> Simulation::kinds() const {
    const SceneParameters& scene = live().run().scene();
    if (scene.effects.species.empty())
        return std::vector<DiscKind>(scene.n_discs, DiscKind{scene.radius, 1, 0});
    std::vector<DiscKind> kinds;
    kinds.reserve(scene.n_discs);
    std::int64_t number = 0;
    for (const Species& species : scene.effects.species)
        kinds.insert(kinds.end(), species.count, {species.radius, species.mass, number++});
    if (scene.effects.swap.is_on())
        for (DiscId id = 0; id < kinds.size(); ++id)
            kinds[id].radius = live().run().system().species_table().of(id).radius;
    return kinds;
}

} // namespace carrom
