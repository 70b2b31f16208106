// SPDX-License-Identifier: BSD-3-Clause
#include "measure/order_tables.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "measure/table_parts.hpp"
#include "statistics/block_averages.hpp"
#include "statistics/hexatic_order.hpp"

namespace carrom {

namespace {

constexpr std::size_t per_sample = 7; ///< numbers of SampleSums::psi6

MeasuredTable psi6_history(const SampleSums& s) {
    MeasuredTable table{
        "psi6_history",
        {"psi6: modulus of its mean over all discs, also by parts; local: mean of "
         "the discs' moduli; times in steps",
         "fivefold, sixfold, sevenfold: shares of discs with so many Voronoi "
         "neighbours"},
        {"step", "psi6", "real", "imaginary", "local", "fivefold", "sixfold", "sevenfold"},
        {}};
    for (std::size_t k = 0; k < s.psi6.size() / per_sample; ++k) {
        const double* const now = s.psi6.data() + per_sample * k;
        std::vector<double> row = {
            static_cast<double>(s.first_step + static_cast<std::int64_t>(k) * s.every_steps),
            psi6_at(s, k)};
        for (std::size_t part = 0; part + 1 < per_sample; ++part)
            row.push_back(now[part] / now[per_sample - 1]);
        table.rows.push_back(std::move(row));
    }
    return table;
}

/// Of the history's columns but step and parts.
MeasuredTable psi6_means(const MeasuredTable& history) {
    MeasuredTable table{"psi6",
                        {"means of the history with one standard error (from joined samples; nan "
                         "where there are too few)"},
                        {},
                        {{}}};
    for (const std::size_t column : {1u, 4u, 5u, 6u, 7u}) {
        std::vector<double> terms;
        for (const std::vector<double>& row : history.rows) terms.push_back(row[column]);
        const double sum = std::accumulate(terms.begin(), terms.end(), 0.0);
        table.columns.push_back(history.columns[column]);
        table.rows[0].push_back(sum / static_cast<double>(terms.size()));
        table.columns.push_back(history.columns[column] + "_error");
        table.rows[0].push_back(standard_error(std::move(terms)));
    }
    return table;
}

MeasuredTable psi6_distribution(const SampleSums& s) {
    const std::size_t n = s.moduli.size();
    MeasuredTable table{"psi6_distribution",
                        {"density: of probability, of the modulus of a disc's psi6"},
                        {"from", "to", "count", "density"},
                        {}};
    for (std::size_t k = 0; k < n; ++k)
        table.rows.push_back({edge(0, 1, k, n), edge(0, 1, k + 1, n),
                              static_cast<double>(s.moduli[k]),
                              share(s.moduli[k], total(s.moduli), 1 / static_cast<double>(n))});
    return table;
}

MeasuredTable psi6_correlation(const SampleSums& s) {
    const std::size_t n = s.psi6_pairs.size();
    MeasuredTable table{"psi6_correlation",
                        {"g6: mean over pairs of the real part of psi6* psi6, 0 without pairs",
                         "distances in the scene's unit of length; pairs: of all samples"},
                        {"from", "to", "pairs", "g6"},
                        {}};
    for (std::size_t k = 0; k < n; ++k) {
        const double pairs = static_cast<double>(s.psi6_pairs[k]);
        table.rows.push_back({edge(0, s.largest_distance, k, n),
                              edge(0, s.largest_distance, k + 1, n), pairs,
                              pairs > 0 ? s.psi6_products[k] / pairs : 0});
    }
    return table;
}

MeasuredTable neighbours(const SampleSums& s) {
    MeasuredTable table{"neighbours",
                        {"count: discs with so many Voronoi neighbours, of all samples; the last "
                         "row is of more, too"},
                        {"neighbours", "count", "share"},
                        {}};
    for (std::size_t k = 0; k < s.neighbours.size(); ++k)
        table.rows.push_back({static_cast<double>(k), static_cast<double>(s.neighbours[k]),
                              share(s.neighbours[k], total(s.neighbours), 1)});
    return table;
}

} // namespace

std::vector<WaveVector> wave_vectors_of(const Scene& scene) {
    const double lx = scene.box.x, ly = scene.box.y;
    return wave_vectors(lx, ly, scene.measurements->largest_wavenumber);
}

void add_structure_tables(const SampleSums& s, const Scene& scene,
                          std::vector<MeasuredTable>& tables) {
    const double lx = scene.box.x, ly = scene.box.y, n_samples = static_cast<double>(s.n_samples);
    const std::vector<WaveVector> vectors = wave_vectors_of(scene);
    const std::size_t n = scene.measurements->bins;
    std::vector<double> sums(n, 0), counts(n, 0);
    std::size_t highest = 0;
    for (std::size_t k = 0; k < vectors.size(); ++k) {
        const double place = wavenumber(vectors[k], lx, ly) / s.largest_wavenumber *
                             static_cast<double>(n);
        const std::size_t bin = std::min(static_cast<std::size_t>(place), n - 1);
        sums[bin] += s.structure_factor[k];
        counts[bin] += 1;
        if (s.structure_factor[k] > s.structure_factor[highest]) highest = k;
    }
    MeasuredTable table{"structure_factor",
                        {"S: mean square of the sum of exp(i k r) over discs, per disc, over the "
                         "box's wave vectors of lengths from `from` to `to`; nan without any",
                         "of each two opposite vectors one counts; wavenumbers in radians per "
                         "length"},
                        {"from", "to", "count", "S"},
                        {}};
    for (std::size_t bin = 0; bin < n; ++bin)
        table.rows.push_back(
            {edge(0, s.largest_wavenumber, bin, n), edge(0, s.largest_wavenumber, bin + 1, n),
             counts[bin], counts[bin] > 0 ? sums[bin] / (counts[bin] * n_samples) : std::nan("")});
    tables.push_back(std::move(table));
    const WaveVector& peak = vectors[highest];
    tables.push_back({"structure_factor_peak",
                      {"the wave vector of the largest mean S of all"},
                      {"kx", "ky", "k", "S"},
                      {{2 * std::numbers::pi * peak.n / lx, 2 * std::numbers::pi * peak.m / ly,
                        wavenumber(peak, lx, ly), s.structure_factor[highest] / n_samples}}});
}

double psi6_at(const SampleSums& s, std::size_t sample) {
    const double* const now = s.psi6.data() + per_sample * sample;
    return std::sqrt(now[0] * now[0] + now[1] * now[1]) / now[per_sample - 1];
}

void add_psi6_tables(const SampleSums& sums, std::vector<MeasuredTable>& tables) {
    MeasuredTable history = psi6_history(sums);
    tables.push_back(psi6_means(history));
    tables.push_back(std::move(history));
    tables.push_back(psi6_distribution(sums));
    tables.push_back(psi6_correlation(sums));
    tables.push_back(neighbours(sums));
}

} // namespace carrom
