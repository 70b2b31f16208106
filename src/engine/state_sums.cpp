// SPDX-License-Identifier: BSD-3-Clause
#include "engine/state_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "core/exact_sum.hpp"
#include "core/state_hash.hpp"
#include "engine/near_pairs.hpp"

namespace carrom {

void measure_collisions(std::span<const DiscState> own, const SideSpans& columns,
                        const Communicator& communicator, int n_threads, Totals& totals) {
    std::uint64_t walls = 0, pairs = 0;
    StateHash hash;
#pragma omp parallel for num_threads(n_threads) schedule(static) reduction(+ : walls, pairs, hash)
    for (std::size_t i = 0; i < own.size(); ++i) {
        walls += own[i].wall_collisions;
        pairs += own[i].pair_collisions;
        hash += hash_of(own[i]);
    }
    for (std::size_t k = 0; k < n_side_columns; ++k)
        for (std::size_t i = 0; i < columns.values[k].size(); ++i)
            hash += hash_of(static_cast<SideColumn>(k), own[i].id, columns.values[k][i]);
    std::uint64_t sums[] = {walls, pairs, hash.low, hash.high};
    communicator.sum(sums);
    totals.wall_collisions = sums[0];
    totals.pair_collisions = sums[1] / 2;
    totals.hash = {sums[2], sums[3]};
}

/// When a disc departs, its centre is exactly a radius beyond the side through which it left. So
/// the coordinate that is furthest outside identifies the side.
void measure_departures(std::span<const DiscState> own, const Box& box,
                        const Communicator& communicator, Totals& totals) {
    for (const DiscState& disc : own) {
        if (!disc.has_departed()) continue;
        const std::array<double, 4> outside{-disc.x, disc.x - box.x, -disc.y, disc.y - box.y};
        totals.departed[static_cast<std::size_t>(std::max_element(outside.begin(), outside.end()) -
                                                 outside.begin())] += 1;
    }
    communicator.sum(totals.departed);
}

std::span<const DiscState> discs_in_box(std::span<const DiscState> discs, const Effects& effects,
                                        const Extent& box, double time, DiscStates& kept) {
    if (!effects.have_open_boundaries()) return discs;
    std::copy_if(discs.begin(), discs.end(), std::back_inserter(kept), [&](const DiscState& disc) {
        const double x = disc.x_at(time), y = disc.y_at(time);
        return x >= box.x_low && x <= box.x_high && y >= box.y_low && y <= box.y_high;
    });
    return kept;
}

namespace {

double mass_of(const DiscState& disc, const SpeciesTable* species_table) {
    return species_table ? species_table->of(disc.id).mass : 1;
}

double largest_mass(std::span<const DiscState> own, const SpeciesTable* species_table,
                    const Communicator& communicator) {
    if (!species_table) return 1;
    double largest = 0;
    for (const DiscState& disc : own) largest = std::max(largest, species_table->of(disc.id).mass);
    return communicator.max(largest);
}

} // namespace

void measure_motion(std::span<const DiscState> own, const SpeciesTable* species_table,
                    double velocity_unit, const Communicator& communicator, int n_threads,
                    Totals& totals) {
    double largest = 0; // largest |vx| or |vy|, per micro-step until it is converted below
#pragma omp parallel for num_threads(n_threads) schedule(static) reduction(max : largest)
    for (std::size_t i = 0; i < own.size(); ++i)
        largest = std::max({largest, std::fabs(own[i].vx), std::fabs(own[i].vy)});
    largest = communicator.max(largest) * velocity_unit;
    const double n = static_cast<double>(totals.n_discs),
                 heaviest = largest_mass(own, species_table, communicator);
    ExactSum energy(n * heaviest * largest * largest), momentum_x(n * heaviest * largest),
        momentum_y(n * heaviest * largest);
#pragma omp parallel for num_threads(n_threads) schedule(static)                                   \
    reduction(+ : energy, momentum_x, momentum_y)
    for (std::size_t i = 0; i < own.size(); ++i) {
        const double vx = own[i].vx * velocity_unit, vy = own[i].vy * velocity_unit;
        const double mass = mass_of(own[i], species_table);
        energy.add(0.5 * mass * (vx * vx + vy * vy));
        momentum_x.add(mass * vx);
        momentum_y.add(mass * vy);
    }
    for (ExactSum* sum : {&energy, &momentum_x, &momentum_y}) communicator.sum(*sum);
    totals.kinetic_energy = energy.value();
    totals.momentum_x = momentum_x.value();
    totals.momentum_y = momentum_y.value();
}

void measure_other_energies(std::span<const OtherEnergy> energies, std::span<const DiscState> shown,
                            std::span<const double> spins, const SpeciesTable& species_table,
                            const EnergySetting& setting, const Communicator& communicator,
                            Totals& totals) {
    const double unit = setting.velocity_unit;
    for (const OtherEnergy& energy : energies) {
        const auto energy_of = [&](std::size_t i) -> double {
            const DiscState& disc = shown[i];
            if (disc.has_departed()) return 0;
            return energy.of_disc({disc.x, disc.y, disc.vx * unit, disc.vy * unit,
                                   spins.empty() ? 0 : spins[i] * unit, species_table.of(disc.id),
                                   setting.sync_interval / unit, disc.id},
                                  setting.effects, setting.box);
        };
        double largest = 0;
        for (std::size_t i = 0; i < shown.size(); ++i)
            largest = std::max(largest, std::fabs(energy_of(i)));
        ExactSum sum(static_cast<double>(totals.n_discs) * communicator.max(largest));
        for (std::size_t i = 0; i < shown.size(); ++i) sum.add(energy_of(i));
        communicator.sum(sum);
        totals.*energy.value += sum.value();
    }
}

namespace {

/// Overlap and relative motion of pairs of discs of a population at the given time.
class PairsAt {
public:
    PairsAt(const Population& population, double time, const Touching& touching)
        : population_(population), time_(time), touching_(touching) {}

    /// Whether this rank counts the pair: it owns the disc with the lower id.
    bool is_mine(LocalIndex a, LocalIndex b) const {
        return (disc(a).id < disc(b).id ? a : b) < population_.n_own;
    }
    double overlap(LocalIndex a, LocalIndex b) const {
        const auto [dx, dy] = separation(a, b);
        return touching_.diameter_of(disc(a), disc(b)) - std::sqrt(dx * dx + dy * dy);
    }
    /// Whether two discs that touch slide along each other.
    bool slide(LocalIndex a, LocalIndex b) const {
        const auto [dx, dy] = separation(a, b);
        const Shift shift = touching_.periods.between(disc(a), disc(b), time_);
        const double wx = (disc(b).vx - disc(a).vx) + shift.vx, wy = disc(b).vy - disc(a).vy,
                     approach = dx * wx + dy * wy, square = wx * wx + wy * wy;
        return square > 0 && approach * approach <= 4 * touching_.tolerance *
                                                        touching_.diameter_of(disc(a), disc(b)) *
                                                        square;
    }

private:
    const DiscState& disc(LocalIndex index) const { return population_.discs[index]; }
    std::pair<double, double> separation(LocalIndex a, LocalIndex b) const {
        const DiscState &p = disc(a), &q = disc(b);
        const double dx = q.x_at(time_) - p.x_at(time_), dy = q.y_at(time_) - p.y_at(time_);
        const Shift shift = touching_.periods.between(p, q, time_);
        return {dx + shift.x, dy + shift.y};
    }

    const Population& population_;
    double time_;
    const Touching& touching_;
};

/// Counts the touching pairs of this rank, how many of these pairs slide, and the discs that touch
/// several others.
std::array<std::uint64_t, 3> count_touching(const PairsAt& pairs, const Population& population,
                                            const CellGrid& grid, double tolerance) {
    std::array<std::uint64_t, 3> counts{};
    // number of partners that touch each disc; 2 means two or more
    std::vector<std::uint8_t> n_partners(population.discs.size(), 0);
    visit_near_pairs(grid, [&](LocalIndex a, LocalIndex b) {
        if (!(std::fabs(pairs.overlap(a, b)) <= tolerance)) return;
        for (const LocalIndex index : {a, b}) n_partners[index] += n_partners[index] < 2;
        counts[0] += pairs.is_mine(a, b);
        counts[1] += pairs.is_mine(a, b) && pairs.slide(a, b);
    });
    for (std::size_t i = 0; i < population.n_own; ++i) counts[2] += n_partners[i] == 2;
    return counts;
}

} // namespace

double largest_size(const Population& population, const CellGrid& grid, const Touching& touching,
                    const Communicator& communicator, int n_threads) {
    Touching of_scene = touching;
    of_scene.size = 1;
    double least = std::numeric_limits<double>::infinity(); // smallest (distance / diameter)^2
    const int n_columns = grid.geometry().n_columns;
#pragma omp parallel for num_threads(n_threads) schedule(dynamic, 8) reduction(min : least)
    for (int column = 0; column < n_columns; ++column) {
        visit_near_pairs_of(grid, column, [&](LocalIndex a, LocalIndex b) {
            if (population.discs[b].id < population.discs[a].id) std::swap(a, b);
            const DiscState &p = population.discs[a], &q = population.discs[b];
            const Shift shift = of_scene.periods.between(p, q, 0);
            const double dx = (q.x - p.x) + shift.x, dy = (q.y - p.y) + shift.y,
                         diameter = of_scene.diameter_of(p, q);
            least = std::min(least, (dx * dx + dy * dy) / (diameter * diameter));
        });
    }
    return std::sqrt(communicator.min(least)) * (1 - 0x1p-40);
}

void measure_overlaps(const Population& population, const CellGrid& grid, double time,
                      const Touching& touching, const Communicator& communicator, int n_threads,
                      Totals& totals) {
    const PairsAt pairs(population, time, touching);
    std::uint64_t n_pairs = 0, n_touching = 0;
    double deepest = 0;
    const int n_columns = grid.geometry().n_columns;
#pragma omp parallel for num_threads(n_threads) schedule(dynamic, 8)                               \
    reduction(+ : n_pairs, n_touching) reduction(max : deepest)
    for (int column = 0; column < n_columns; ++column) {
        visit_near_pairs_of(grid, column, [&](LocalIndex first, LocalIndex second) {
            const double overlap = pairs.overlap(first, second);
            if (!(overlap >= -touching.tolerance)) return;
            if (overlap <= touching.tolerance) {
                ++n_touching;
                return;
            }
            n_pairs += pairs.is_mine(first, second);
            deepest = std::max(deepest, overlap);
        });
    }
    totals.overlapping_pairs = communicator.sum(n_pairs);
    totals.deepest_overlap = communicator.max(deepest);
    // Touching pairs are rare, so a rank without any skips the second pass.
    std::array<std::uint64_t, 3> counts{};
    if (n_touching > 0) counts = count_touching(pairs, population, grid, touching.tolerance);
    communicator.sum(counts);
    totals.touching_pairs = counts[0];
    totals.sliding_pairs = counts[1];
    totals.chained_discs = counts[2];
}

} // namespace carrom
