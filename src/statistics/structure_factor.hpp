// SPDX-License-Identifier: BSD-3-Clause
// The Fourier modes of the density of discs: sums of exp(i k r) for the wave vectors of a periodic
// box, k = 2 pi (n / Lx, m / Ly).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/disc_state.hpp"
#include "dynamics/effects.hpp"

namespace carrom {

struct WaveVector {
    int n = 0, m = 0;
};

/// The length of the wave vector.
double wavenumber(const WaveVector& vector, double lx, double ly);

/// The wave vectors up to `largest_wavenumber`, in ascending order of n from 0, then of m. Of two
/// opposite vectors only one is listed.
std::vector<WaveVector> wave_vectors(double lx, double ly, double largest_wavenumber);

/// The modes of a rank's discs, in fixed point.
struct DensityModes {
    std::vector<std::uint64_t> real, imaginary; ///< sums over ranks are modulo 2^64
    double per_unit = 1;

    double squared_modulus(std::size_t vector) const { return product(*this, vector); }
    /// The real part of a mode times the complex conjugate of another mode of the same vector.
    double product(const DensityModes& other, std::size_t vector) const {
        return part(real, vector) * other.part(other.real, vector) +
               part(imaginary, vector) * other.part(other.imaginary, vector);
    }

private:
    double part(const std::vector<std::uint64_t>& parts, std::size_t vector) const {
        return static_cast<double>(static_cast<std::int64_t>(parts[vector])) * per_unit;
    }
};

/// `discs` are in box coordinates at `time`; `n_discs` counts the discs of all ranks. Cost: some
/// nanoseconds for each disc and vector.
DensityModes density_modes(std::span<const DiscState> discs, double time, std::uint64_t n_discs,
                           double lx, double ly, std::span<const WaveVector> vectors,
                           int n_threads);

} // namespace carrom
