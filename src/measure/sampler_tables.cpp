// SPDX-License-Identifier: BSD-3-Clause
// From sums over samples to what a physicist plots. Every rank computes the same numbers from the
// same sums.
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "measure/diffusion_tables.hpp"
#include "measure/order_tables.hpp"
#include "measure/sampler.hpp"
#include "measure/table_parts.hpp"
#include "statistics/block_averages.hpp"
#include "statistics/pair_distances.hpp"

namespace carrom {

namespace {

MeasuredTable radial_distribution(const SampleSums& s, const Scene& scene) {
    MeasuredTable table{"radial_distribution",
                        {"g: pairs at a distance from `from` to `to`, over those that as many "
                         "discs without size would have, anywhere in the box that centres have",
                         "distances in the scene's unit of length; pairs: of all samples"},
                        {"from", "to", "pairs", "g"},
                        {}};
    const std::size_t n_species = species_apart(scene).size(), n_kinds = n_pair_kinds(n_species),
                      n = s.pairs.size() / n_kinds;
    if (n_kinds > 1)
        table.remarks.push_back("pairs_a_b, g_a_b: of a disc of species a and one of species b, "
                                "species counted from 1 in the order of ids");
    for (std::size_t b = 1; b <= n_species && n_kinds > 1; ++b)
        for (std::size_t a = 1; a <= b; ++a)
            for (const char* what : {"pairs", "g"})
                table.columns.push_back(fmt::format("{}_{}_{}", what, a, b));
    for (std::size_t k = 0; k < n; ++k) {
        std::vector<double> row = {edge(0, s.largest_distance, k, n),
                                   edge(0, s.largest_distance, k + 1, n), 0, 0};
        std::uint64_t all = 0;
        double ideal = 0;
        const auto g = [](std::uint64_t pairs, double ideal_pairs) {
            return ideal_pairs > 0 ? static_cast<double>(pairs) / ideal_pairs : 0;
        };
        for (std::size_t place = k; place < s.pairs.size(); place += n) {
            all += s.pairs[place];
            ideal += s.ideal_pairs[place];
            if (n_kinds > 1)
                row.insert(row.end(), {static_cast<double>(s.pairs[place]),
                                       g(s.pairs[place], s.ideal_pairs[place])});
        }
        row[2] = static_cast<double>(all);
        row[3] = g(all, ideal);
        table.rows.push_back(std::move(row));
    }
    return table;
}

MeasuredTable velocities(const SampleSums& s) {
    const std::size_t n = s.vx.size();
    const double largest = s.largest_velocity, width = 2 * largest / static_cast<double>(n);
    MeasuredTable table{"velocities",
                        {"vx_density, vy_density: of probability, per length per step; velocities "
                         "in lengths per step",
                         fmt::format("beyond the table: {} of vx, {} of vy, of {}",
                                     s.n_discs - total(s.vx), s.n_discs - total(s.vy), s.n_discs)},
                        {"from", "to", "vx_count", "vy_count", "vx_density", "vy_density"},
                        {}};
    for (std::size_t k = 0; k < n; ++k)
        table.rows.push_back({edge(-largest, largest, k, n), edge(-largest, largest, k + 1, n),
                              static_cast<double>(s.vx[k]), static_cast<double>(s.vy[k]),
                              share(s.vx[k], s.n_discs, width), share(s.vy[k], s.n_discs, width)});
    return table;
}

MeasuredTable speeds(const SampleSums& s) {
    const std::size_t n = s.speeds.size();
    const double width = s.largest_velocity / static_cast<double>(n);
    MeasuredTable table{
        "speeds",
        {"density: of probability, per length per step; speeds in lengths per step",
         fmt::format("beyond the table: {} of {}", s.n_discs - total(s.speeds), s.n_discs)},
        {"from", "to", "count", "density"},
        {}};
    for (std::size_t k = 0; k < n; ++k)
        table.rows.push_back(
            {edge(0, s.largest_velocity, k, n), edge(0, s.largest_velocity, k + 1, n),
             static_cast<double>(s.speeds[k]), share(s.speeds[k], s.n_discs, width)});
    return table;
}

/// Where walls move, places are shares of the box as it is at each sample.
MeasuredTable density(const SampleSums& s, const Scene& scene,
                      const std::vector<std::uint64_t>& counts, const char* axis, double length) {
    bool is_moving = false;
    for (const Boundary& side : scene.effects.boundaries)
        is_moving = is_moving || side.speed != 0 || side.amplitude != 0;
    const std::size_t n = counts.size();
    const double size = is_moving ? 1 : length, area = s.area / static_cast<double>(n);
    MeasuredTable table{
        fmt::format("density_{}", axis),
        {fmt::format("density: discs' centres per area, in strips from `from` to `to` along {}",
                     axis),
         is_moving ? "walls move: places are shares of the box's side at each sample"
                   : "lengths in the scene's unit"},
        {"from", "to", "count", "density"},
        {}};
    for (std::size_t k = 0; k < n; ++k)
        table.rows.push_back({edge(0, size, k, n), edge(0, size, k + 1, n),
                              static_cast<double>(counts[k]),
                              static_cast<double>(counts[k]) / area});
    return table;
}

/// The length of a side, at a step; of one between oscillating walls in the mean.
double length_of(const Scene& scene, std::size_t side, double step) {
    const Extent box = extent_of_lines(scene.effects, scene.box, step);
    return side < 2 ? box.y_high - box.y_low : box.x_high - box.x_low;
}

MeasuredTable pressure_history(const SampleSums& s, const Scene& scene) {
    MeasuredTable table{"wall_pressure_history",
                        {"impulse that each side was given between two steps, over its length and "
                         "that time (nan: a periodic side); masses of 1, times in steps"},
                        {"from_step", "to_step", "left", "right", "bottom", "top"},
                        {}};
    for (std::size_t k = 0; k < s.impulses.size() / 4; ++k) {
        const double from = static_cast<double>(s.first_step +
                                                static_cast<std::int64_t>(k) * s.every_steps);
        const double to = from + static_cast<double>(s.every_steps);
        std::vector<double> row = {from, to};
        for (std::size_t side = 0; side < 4;
             ++side) // walls move evenly: their mean length is that in the middle
            row.push_back(scene.effects.boundaries[side].is_periodic()
                              ? std::nan("")
                              : s.impulses[4 * k + side] /
                                    (length_of(scene, side, (from + to) / 2) * (to - from)));
        table.rows.push_back(std::move(row));
    }
    return table;
}

MeasuredTable wall_pressure(const SampleSums& s, const MeasuredTable& history) {
    MeasuredTable table{
        "wall_pressure",
        {"mean pressure on each side with one standard error (from joined intervals of the "
         "history; nan where there are too few), and collisions with it"},
        {"left", "right", "bottom", "top", "left_error", "right_error", "bottom_error", "top_error",
         "left_collisions", "right_collisions", "bottom_collisions", "top_collisions"},
        {}};
    std::vector<double> means, errors, counts;
    for (std::size_t side = 0; side < 4; ++side) {
        std::vector<double> terms;
        double sum = 0;
        for (const std::vector<double>& row : history.rows) {
            terms.push_back(row[2 + side]);
            sum += terms.back();
        }
        means.push_back(sum / static_cast<double>(terms.size()));
        errors.push_back(standard_error(terms));
        counts.push_back(static_cast<double>(s.wall_collisions[side]));
    }
    table.rows.emplace_back();
    for (const auto* part : {&means, &errors, &counts})
        table.rows[0].insert(table.rows[0].end(), part->begin(), part->end());
    return table;
}

MeasuredTable pressure_tensor_history(const SampleSums& s) {
    MeasuredTable table{
        "pressure_history",
        {"pressure tensor between two steps: impulse times distance of pairs, and "
         "the kinetic part at both; docs/understanding/pressure.md",
         "pressure: half the trace; compressibility: P A / (N kT); kT of "
         "translation; times in steps"},
        {"from_step", "to_step", "xx", "xy", "yy", "pressure", "kT", "compressibility"},
        {}};
    for (std::size_t k = 0; k < s.pressures.size() / 5; ++k) {
        const double* const one = s.pressures.data() + 5 * k;
        const double from = static_cast<double>(s.first_step +
                                                static_cast<std::int64_t>(k) * s.every_steps);
        const double pressure = (one[0] + one[2]) / 2;
        table.rows.push_back({from, from + static_cast<double>(s.every_steps), one[0], one[1],
                              one[2], pressure, one[3], pressure / one[4]});
    }
    return table;
}

/// Of the history's columns from `xx` on. The compressibility is that of the mean pressure.
MeasuredTable pressure(const SampleSums& s, const MeasuredTable& history) {
    MeasuredTable table{"pressure",
                        {"means of the history with one standard error (from joined intervals; nan "
                         "where there are too few)"},
                        {},
                        {}};
    std::vector<double> means, errors;
    for (std::size_t column = 2; column < history.columns.size(); ++column) {
        std::vector<double> terms;
        for (const std::vector<double>& row : history.rows) terms.push_back(row[column]);
        const double sum = std::accumulate(terms.begin(), terms.end(), 0.0);
        means.push_back(sum / static_cast<double>(terms.size()));
        errors.push_back(standard_error(terms));
        table.columns.push_back(history.columns[column]);
    }
    double ideal = 0;
    for (std::size_t k = 4; k < s.pressures.size(); k += 5) ideal += s.pressures[k];
    means.back() = means[3] * static_cast<double>(history.rows.size()) / ideal;
    for (std::size_t column = 2; column < history.columns.size(); ++column)
        table.columns.push_back(history.columns[column] + "_error");
    means.insert(means.end(), errors.begin(), errors.end());
    table.rows.push_back(std::move(means));
    return table;
}

MeasuredTable displacement(const SampleSums& s) {
    MeasuredTable table{"displacement",
                        {"mean square displacement since from_step, over all discs, on through "
                         "periodic sides; lengths squared, times in steps"},
                        {"steps", "x", "y", "sum"},
                        {}};
    for (std::size_t k = 0; k < s.displacements.size() / 2; ++k) {
        const double x = s.displacements[2 * k], y = s.displacements[2 * k + 1];
        table.rows.push_back(
            {static_cast<double>(static_cast<std::int64_t>(k) * s.every_steps), x, y, x + y});
    }
    return table;
}

} // namespace

MeasuredTable thermo(const SampleSums& s, std::size_t first) {
    MeasuredTable table{
        "thermo",
        {fmt::format("one row every {} steps from step {}", s.every_steps, s.first_step),
         "energy: of motion, spin and height; temperature: kT; collision_rate: collisions with "
         "other discs per disc and step",
         "xx, xy, yy (pressure tensor), collision_rate: since the row before; times in steps"},
        {"step", "time", "energy", "temperature", "xx", "xy", "yy", "collision_rate"},
        {}};
    const bool with_psi6 = !s.psi6.empty();
    if (with_psi6) {
        table.columns.push_back("psi6");
        table.remarks.push_back("psi6: of all discs together");
    }
    for (std::size_t k = first; k < s.thermo.size() / 4; ++k) {
        const double* const now = s.thermo.data() + 4 * k;
        const double step = static_cast<double>(s.first_step +
                                                static_cast<std::int64_t>(k) * s.every_steps);
        std::vector<double> row = {step, step, now[0], now[1]};
        if (k == 0) {
            row.resize(row.size() + 4, std::nan(""));
        } else {
            const double* const before = now - 4;
            const double* const p = s.pressures.data() + 5 * (k - 1);
            const double steps = static_cast<double>(s.every_steps),
                         n_discs = (before[2] + now[2]) / 2;
            row.insert(row.end(), {p[0], p[1], p[2], 2 * (now[3] - before[3]) / (n_discs * steps)});
        }
        if (with_psi6) row.push_back(psi6_at(s, k));
        table.rows.push_back(std::move(row));
    }
    return table;
}

std::vector<MeasuredTable> tables_of(const SampleSums& sums, const Scene& scene) {
    const MeasurementOutput& output = *scene.measurements;
    std::vector<MeasuredTable> tables;
    if (output.wall_pressure && !sums.impulses.empty()) {
        MeasuredTable history = pressure_history(sums, scene);
        tables.push_back(wall_pressure(sums, history));
        tables.push_back(std::move(history));
    }
    if (output.radial_distribution) tables.push_back(radial_distribution(sums, scene));
    if (output.velocities) {
        tables.push_back(velocities(sums));
        tables.push_back(speeds(sums));
    }
    if (output.density) {
        tables.push_back(density(sums, scene, sums.x, "x", scene.box.x));
        tables.push_back(density(sums, scene, sums.y, "y", scene.box.y));
    }
    if (output.displacement) tables.push_back(displacement(sums));
    if (output.pressure && !sums.pressures.empty()) {
        MeasuredTable history = pressure_tensor_history(sums);
        tables.push_back(pressure(sums, history));
        tables.push_back(std::move(history));
    }
    if (output.psi6) add_psi6_tables(sums, tables);
    if (output.diffusion) add_diffusion_tables(sums, tables);
    if (output.structure_factor) add_structure_tables(sums, scene, tables);
    const std::string what = fmt::format("{} samples, steps {} to {}, one every {}", sums.n_samples,
                                         sums.first_step, sums.last_step, sums.every_steps);
    for (MeasuredTable& table : tables) table.remarks.insert(table.remarks.begin(), what);
    if (output.thermo) tables.push_back(thermo(sums));
    return tables;
}

} // namespace carrom
