// SPDX-License-Identifier: BSD-3-Clause
// The modes of the density of discs, the sums of exp(i k r), on the vectors of a periodic box:
// k = 2 pi (n / Lx, m / Ly).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/disc.hpp"
#include "dynamics/effects.hpp"

namespace carrom {

struct WaveVector {
    int n = 0, m = 0;
};

/// The length of k.
double wavenumber(const WaveVector& vector, double lx, double ly);

/// Those up to a length, of each two opposite ones one: n ascending from 0, then m.
std::vector<WaveVector> wave_vectors(double lx, double ly, double largest_wavenumber);
/// About how many these are.
double n_wave_vectors(double lx, double ly, double largest_wavenumber);

/// The modes of a rank's discs, in fixed point.
struct DensityModes {
    std::vector<std::uint64_t> real, imaginary; ///< to be added over ranks, wrapping
    double per_unit = 1;

    double squared_modulus(std::size_t vector) const {
        const double a = static_cast<double>(static_cast<std::int64_t>(real[vector])) * per_unit,
                     b = static_cast<double>(static_cast<std::int64_t>(imaginary[vector])) *
                         per_unit;
        return a * a + b * b;
    }
};

/// `discs` as the box sees them at `time`; `n_discs` over all ranks. Price: some nanoseconds for
/// each disc and vector.
DensityModes density_modes(std::span<const Disc> discs, double time, std::uint64_t n_discs,
                           double lx, double ly, std::span<const WaveVector> vectors,
                           int n_threads);

} // namespace carrom
