// SPDX-License-Identifier: BSD-3-Clause
// Fields of a cell over a block of samples, relative to the cell's mean velocity in the block.
//
// The mean velocity V of a block comes from the same discs, so it contains part of their thermal
// motion. So kT from velocities relative to V is too low by D kT / n, where n is the number of
// discs, summed over all s samples, and D a number of degrees of freedom. D is 1 if samples are
// independent, and s if all samples are equal. It usually lies between, as successive samples
// contain the same discs. D follows from the scatter of the cell's velocities V_k at the samples:
//
//   sum_k sum_i m (v - V)^2  =  sum_k sum_i m (v - V_k)^2  +  sum_k M_k (V_k - V)^2
//      mean (n - D) kT                mean (n - s) kT               mean (s - D) kT
//
// The middle sum does not depend on D, so it gives kT, and the missing part is D kT. The terms of a
// sample with n_k discs are multiplied by n_k / (n_k - 1), so that each disc has the same weight in
// kT. If the flow changes within the block, the last sum is larger than thermal motion can make it.
// In this case the fields include the last sum, and the correction uses D = 1.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "measure/field_sums.hpp"

namespace carrom {

/// Sums over the samples of a block, the same on all ranks. Fluxes and heat flows are relative to
/// V_k, the cell's velocity in sample k. Weights correct for the share that each disc has in V_k.
enum SampleMoment : std::uint8_t {
    sample_count,   ///< number of samples with a disc in the cell
    sample_drift,   ///< sum of M_k V_k^2, where M_k is the mass in the cell in sample k
    sample_in_pair, ///< discs in the cell, summed over samples with two or more discs
    sample_flux_xx,
    sample_flux_xy,
    sample_flux_yy,
    sample_in_three, ///< discs in the cell, summed over samples with three or more discs
    sample_heat_x,
    sample_heat_y,
    n_sample_moments
};

/// Number of values that are stored for each cell and block: first the number of discs, summed over
/// the samples, then the field moments (FieldMoment), then the sample moments.
inline constexpr std::size_t n_block_numbers = 1 + n_field_moments + n_sample_moments;
using BlockNumbers = std::span<const double, n_block_numbers>;
using SampleSums = std::span<double, n_sample_moments>;

/// Adds one sample of a cell, with the discs of all ranks, to `sums`.
void add_sample(const FieldSums& sample, std::size_t cell, SampleSums sums);

/// Mean kT of all cells in a block, weighted by their numbers of discs. `cells` has the
/// BlockNumbers of each cell.
double common_temperature(std::span<const double> cells);

/// The columns of "profiles" from `count` on; `common` is common_temperature(). kT and the kinetic
/// stress are NaN if no sample has two or more discs in the cell. The kinetic heat flow is NaN if
/// no sample has three or more, unless the flow changes within the block.
std::vector<double> fields_of(BlockNumbers cell, double common, double n_samples, double steps,
                              double area);

} // namespace carrom
