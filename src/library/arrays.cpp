// SPDX-License-Identifier: BSD-3-Clause
// Numbers of all discs by their ids, for programs that work on arrays. Threads fill them without a
// sort, because a disc's place in an array is its id.
#include <bit>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "library/live_part.hpp"
#include "library/simulation_state.hpp"
#include "parallel/meeting.hpp"

namespace carrom {

namespace {

void check_size(const char* call, std::size_t size, std::uint64_t wanted) {
    if (size != wanted)
        throw InputError(
            {{call, 0, fmt::format("has room for {} numbers; it wants {}", size, wanted)}});
}

/// Whether a coordinate may be outside of [0, period), or below 0 without a period. One comparison
/// is enough, because the bits of numbers from 0 on are ordered like the numbers, and the bits of
/// negative numbers are larger.
bool may_be_outside(double place, double period) {
    const double end = period == 0 ? std::numeric_limits<double>::infinity() : period;
    return std::bit_cast<std::uint64_t>(place) >= std::bit_cast<std::uint64_t>(end);
}

/// Not inlined, so that the loop over all discs is short.
template <class Put>
[[gnu::noinline]] void put_from_outside(const Frame& frame, const DiscState& stored, double time,
                                        const Put& put) {
    const DiscState disc = frame.in_box(stored, time);
    put(disc.id, disc.x, disc.y);
}

/// Calls `put(id, x, y)` for each disc of this rank, on all threads. A disc that may be outside the
/// box or has departed can get two calls; the last one has the right position.
template <class Put> void for_each_place(const Run& run, const Put& put) {
    const DiscSystem& system = run.system();
    const std::span<const DiscState> discs = system.discs();
    const Frame frame = system.frame();
    const double time = system.clock();
    const auto n = static_cast<std::int64_t>(discs.size());
#pragma omp parallel num_threads(run.n_threads())
    if (frame.is_moving) {
        const double x_period = frame.periods.x, y_period = frame.periods.y;
        const double x_moved = frame.x, y_moved = frame.y;
#pragma omp for schedule(static)
        for (std::int64_t i = 0; i < n; ++i) {
            const DiscState& disc = discs[static_cast<std::size_t>(i)];
            const double x = disc.x_at(time) + x_moved, y = disc.y_at(time) + y_moved;
            put(disc.id, x, y);
            if (may_be_outside(x, x_period) || may_be_outside(y, y_period) || disc.has_departed())
                [[unlikely]]
                put_from_outside(frame, disc, time, put);
        }
    } else {
#pragma omp for schedule(static)
        for (std::int64_t i = 0; i < n; ++i) {
            const DiscState& disc = discs[static_cast<std::size_t>(i)];
            put(disc.id, disc.x_at(time), disc.y_at(time));
        }
    }
}

/// Calls `put(disc, i)` for each disc i of this rank, in the frame of the box, on all threads.
template <class Put> void for_each_shown(const Run& run, const Put& put) {
    const DiscSystem& system = run.system();
    const std::span<const DiscState> discs = system.discs();
    const Frame frame = system.frame();
    const double time = system.clock();
    const auto n = static_cast<std::int64_t>(discs.size());
#pragma omp parallel for schedule(static) num_threads(run.n_threads())
    for (std::int64_t i = 0; i < n; ++i) {
        const auto place = static_cast<std::size_t>(i);
        put(frame.in_box(discs[place], time), place);
    }
}

} // namespace

void Simulation::read_positions(std::span<double> xy) const {
    check_size("read_positions", xy.size(), 2 * scene().n_discs);
    const Origin& origin = live().run().scene().origin;
    for_each_place(live().run(), [&](DiscId id, double x, double y) {
        xy[2 * id] = x - origin.x;
        xy[2 * id + 1] = y - origin.y;
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
