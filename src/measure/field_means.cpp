// SPDX-License-Identifier: BSD-3-Clause
#include "measure/field_means.hpp"

#include <cmath>

namespace carrom {

namespace {

struct Moments {
    double xx = 0, xy = 0, yy = 0;

    double trace() const { return xx + yy; }
    Moments plus(double factor, const Moments& other) const {
        return {xx + factor * other.xx, xy + factor * other.xy, yy + factor * other.yy};
    }
};

const double* samples_of(BlockNumbers cell) { return cell.data() + 1 + n_field_moments; }

/// The tensor of kT, from velocities relative to the mean velocity of the cell in each sample.
Moments thermal_of(BlockNumbers cell) {
    const double* const sampled = samples_of(cell);
    const double n = sampled[sample_in_pair]; // 0 / 0 is NaN
    return {sampled[sample_flux_xx] / n, sampled[sample_flux_xy] / n, sampled[sample_flux_yy] / n};
}

/// One component of the sum of m c^2 c / 2, for velocities c relative to the mean (vx, vy).
/// `energy` is the same component of this sum for velocities relative to the box, `v` is the same
/// component of the mean, and (along_x, along_y) is the row of the momentum flux for this axis.
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
    const double xx = sample.value(cell, field_flux_xx), xy = sample.value(cell, field_flux_xy),
                 yy = sample.value(cell, field_flux_yy);
    sums[sample_count] += 1;
    sums[sample_drift] += m * (vx * vx + vy * vy);
    if (n < 2) return;
    const double of_squares = n / (n - 1);
    sums[sample_in_pair] += n;
    sums[sample_flux_xx] += of_squares * (xx - m * vx * vx);
    sums[sample_flux_xy] += of_squares * (xy - m * vx * vy);
    sums[sample_flux_yy] += of_squares * (yy - m * vy * vy);
    if (n < 3) return; // the thermal motion of two discs relative to their mean carries no heat
    const double of_heat = n * n / ((n - 1) * (n - 2));
    sums[sample_in_three] += n;
    sums[sample_heat_x] += of_heat * heat_about(sample.value(cell, field_energy_x), vx, xx, xy,
                                                xx + yy, m, vx, vy);
    sums[sample_heat_y] += of_heat * heat_about(sample.value(cell, field_energy_y), vy, xy, yy,
                                                xx + yy, m, vx, vy);
}

double common_temperature(std::span<const double> cells) {
    double energy = 0, n = 0;
    for (std::size_t k = 0; k < cells.size(); k += n_block_numbers) {
        const double* const sampled = samples_of(BlockNumbers(cells.data() + k, n_block_numbers));
        energy += (sampled[sample_flux_xx] + sampled[sample_flux_yy]) / 2;
        n += sampled[sample_in_pair];
    }
    return n > 0 ? energy / n : 0;
}

namespace {

/// Kinetic stress and heat flow relative to the block's mean velocity, summed over the samples of
/// the block.
struct Kinetic {
    Moments stress;
    double heat_x, heat_y;
};

Kinetic kinetic_of(BlockNumbers cell, double common, double vx, double vy) {
    const double* const sampled = samples_of(cell);
    const double n = cell[0], m = cell[1 + field_mass], s = sampled[sample_count];
    const Moments thermal = thermal_of(cell);
    // Thermal motion alone stays below this limit in all but one of a million cells.
    const double scatter = sampled[sample_drift] - m * (vx * vx + vy * vy),
                 limit = 2 * std::fmax(thermal.trace() / 2, common) * (s + 5 * std::sqrt(s));
    if (!(scatter > limit)) {
        const double per_three = n / sampled[sample_in_three];
        return {Moments{}.plus(n, thermal), per_three * sampled[sample_heat_x],
                per_three * sampled[sample_heat_y]};
    }
    const Moments flux{cell[1 + field_flux_xx], cell[1 + field_flux_xy], cell[1 + field_flux_yy]};
    return {flux.plus(-m, {vx * vx, vx * vy, vy * vy}).plus(1, thermal),
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
            samples_of(cell)[sample_in_pair],
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
