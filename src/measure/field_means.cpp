// SPDX-License-Identifier: BSD-3-Clause
#include "measure/field_means.hpp"

#include <cmath>
#include <limits>

namespace carrom {

namespace {

struct Moments {
    double xx = 0, xy = 0, yy = 0;

    double trace() const { return xx + yy; }
    Moments without(const Moments& other) const {
        return {xx - other.xx, xy - other.xy, yy - other.yy};
    }
    Moments times(double factor) const { return {factor * xx, factor * xy, factor * yy}; }
};

Moments flux_of(BlockNumbers cell) {
    return {cell[1 + field_flux_xx], cell[1 + field_flux_xy], cell[1 + field_flux_yy]};
}
Moments sampled_flux_of(BlockNumbers cell) {
    const double* const first = cell.data() + 1 + n_field_moments;
    return {first[sample_flux_xx], first[sample_flux_xy], first[sample_flux_yy]};
}

/// The sum of m c^2 c / 2 over velocities c about the mean (vx, vy), from that over velocities:
/// `energy` along the same axis as `v`, whose row of the flux is (along_x, along_y).
double heat_about(double energy, double v, double along_x, double along_y, double flux, double mass,
                  double vx, double vy) {
    return energy - v * flux / 2 - vx * along_x - vy * along_y + mass * (vx * vx + vy * vy) * v;
}

} // namespace

void add_sample(const FieldSums& sample, std::size_t cell, SampleSums sums) {
    if (sample.count(cell) == 0) return;
    const double n = static_cast<double>(sample.count(cell)), m = sample.value(cell, field_mass);
    const double vx = sample.value(cell, field_momentum_x) / m,
                 vy = sample.value(cell, field_momentum_y) / m;
    sums[sample_count] += 1;
    sums[sample_flux_xx] += m * vx * vx;
    sums[sample_flux_xy] += m * vx * vy;
    sums[sample_flux_yy] += m * vy * vy;
    if (n < 3) return; // their thermal motion about V_k carries no heat
    const double xx = sample.value(cell, field_flux_xx), xy = sample.value(cell, field_flux_xy),
                 yy = sample.value(cell, field_flux_yy);
    sums[sample_heat_x] += heat_about(sample.value(cell, field_energy_x), vx, xx, xy, xx + yy, m,
                                      vx, vy);
    sums[sample_heat_y] += heat_about(sample.value(cell, field_energy_y), vy, xy, yy, xx + yy, m,
                                      vx, vy);
    sums[sample_heat_freedom] += (n - 1) * (n - 2) / n;
}

double common_temperature(std::span<const double> cells) {
    double energy = 0, freedom = 0;
    for (std::size_t k = 0; k < cells.size(); k += n_block_numbers) {
        const BlockNumbers cell(cells.data() + k, n_block_numbers);
        energy += flux_of(cell).without(sampled_flux_of(cell)).trace() / 2;
        freedom += cell[0] - cell[1 + n_field_moments + sample_count];
    }
    return freedom > 0 ? energy / freedom : 0;
}

namespace {

/// What discs carry about the mean velocity of the block.
struct Kinetic {
    Moments stress;
    double heat_x, heat_y;
};

Kinetic kinetic_of(BlockNumbers cell, double common, double vx, double vy) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const double* const sampled = cell.data() + 1 + n_field_moments;
    const double n = cell[0], m = cell[1 + field_mass], s = sampled[sample_count], freedom = n - s;
    const Moments flux = flux_of(cell), of_block = Moments{vx * vx, vx * vy, vy * vy}.times(m),
                  thermal = flux.without(sampled_flux_of(cell))
                                .times(freedom > 0 ? 1 / freedom : unknown);
    // Thermal motion alone stays below this limit in all but one of a million cells.
    const double scatter = sampled_flux_of(cell).without(of_block).trace(),
                 limit = 2 * std::fmax(thermal.trace() / 2, common) * (s + 5 * std::sqrt(s));
    if (!(scatter > limit)) {
        const double of_heat = sampled[sample_heat_freedom] > 0 ? n / sampled[sample_heat_freedom]
                                                                : unknown;
        return {thermal.times(n), of_heat * sampled[sample_heat_x],
                of_heat * sampled[sample_heat_y]};
    }
    const Moments about = flux.without(of_block);
    return {about.without(thermal.times(-1)),
            heat_about(cell[1 + field_energy_x], vx, flux.xx, flux.xy, flux.trace(), m, vx, vy),
            heat_about(cell[1 + field_energy_y], vy, flux.xy, flux.yy, flux.trace(), m, vx, vy)};
}

} // namespace

std::vector<double> fields_of(BlockNumbers cell, double common, double n_samples, double steps,
                              double area) {
    const double n = cell[0], m = cell[1 + field_mass];
    const double vx = cell[1 + field_momentum_x] / m, vy = cell[1 + field_momentum_y] / m;
    const double per_area = 1 / (n_samples * area), per_time = 1 / (steps * area);
    const Kinetic kinetic = kinetic_of(cell, common, vx, vy);
    const double xx = cell[1 + field_stress_xx], xy = cell[1 + field_stress_xy],
                 yy = cell[1 + field_stress_yy];
    return {n,
            n * per_area,
            vx,
            vy,
            kinetic.stress.trace() / (2 * n),
            kinetic.stress.xx * per_area,
            kinetic.stress.xy * per_area,
            kinetic.stress.yy * per_area,
            xx * per_time,
            xy * per_time,
            yy * per_time,
            kinetic.heat_x * per_area,
            kinetic.heat_y * per_area,
            (cell[1 + field_heat_x] - vx * xx - vy * xy) * per_time,
            (cell[1 + field_heat_y] - vx * xy - vy * yy) * per_time};
}

} // namespace carrom
