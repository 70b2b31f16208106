// SPDX-License-Identifier: BSD-3-Clause
#include "statistics/structure_factor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace carrom {

namespace {

constexpr std::size_t discs_at_once = 128; ///< number of discs whose phases fit in the cache
using Lane = std::array<double, discs_at_once>;

/// The factors exp(2 pi i n x / length) of a group of discs along one axis, for n = 0, 1, ...
struct Phases {
    std::vector<Lane> real, imaginary;

    explicit Phases(std::size_t n_most) : real(n_most + 1), imaginary(n_most + 1) {
        real[0].fill(1);
        imaginary[0].fill(0);
    }
    void set(std::size_t disc, double share_of_length) {
        const double angle = 2 * std::numbers::pi * share_of_length, c = std::cos(angle),
                     s = std::sin(angle);
        for (std::size_t n = 1; n < real.size(); ++n) {
            real[n][disc] = real[n - 1][disc] * c - imaginary[n - 1][disc] * s;
            imaginary[n][disc] = real[n - 1][disc] * s + imaginary[n - 1][disc] * c;
        }
    }
};

struct Mode {
    double real = 0, imaginary = 0;
};

/// Sums exp(i k r) over a group of discs. Each term is rounded to whole units of DensityModes by
/// adding and subtracting a large number, so the sum is exact in any order.
Mode mode_of(const Phases& x, const Phases& y, const WaveVector& vector, std::size_t n_discs,
             double rounder) {
    const auto n = static_cast<std::size_t>(vector.n),
               m = static_cast<std::size_t>(std::abs(vector.m));
    const double sign = vector.m < 0 ? -1 : 1;
    const Lane &xr = x.real[n], &xi = x.imaginary[n], &yr = y.real[m], &yi = y.imaginary[m];
    double real = 0, imaginary = 0;
#pragma omp simd reduction(+ : real, imaginary)
    for (std::size_t j = 0; j < n_discs; ++j) {
        const double s = sign * yi[j];
        real += (xr[j] * yr[j] - xi[j] * s + rounder) - rounder;
        imaginary += (xr[j] * s + xi[j] * yr[j] + rounder) - rounder;
    }
    return {real, imaginary};
}

} // namespace

double wavenumber(const WaveVector& vector, double lx, double ly) {
    const double kx = 2 * std::numbers::pi * vector.n / lx,
                 ky = 2 * std::numbers::pi * vector.m / ly;
    return std::sqrt(kx * kx + ky * ky);
}

std::vector<WaveVector> wave_vectors(double lx, double ly, double largest_wavenumber) {
    const auto most = [largest_wavenumber](double length) {
        return static_cast<int>(largest_wavenumber * length / (2 * std::numbers::pi)) + 1;
    };
    std::vector<WaveVector> vectors;
    for (int n = 0; n <= most(lx); ++n)
        for (int m = n == 0 ? 1 : -most(ly); m <= most(ly); ++m)
            if (wavenumber({n, m}, lx, ly) <= largest_wavenumber) vectors.push_back({n, m});
    return vectors;
}

DensityModes density_modes(std::span<const DiscState> discs, double time, std::uint64_t n_discs,
                           double lx, double ly, std::span<const WaveVector> vectors,
                           int n_threads) {
    const int digits = 51 -
                       static_cast<int>(std::ceil(std::log2(static_cast<double>(n_discs) + 1)));
    const double rounder = std::ldexp(1.5, 52 - digits);
    std::size_t n_most = 0, m_most = 0;
    for (const WaveVector& one : vectors) {
        n_most = std::max(n_most, static_cast<std::size_t>(one.n));
        m_most = std::max(m_most, static_cast<std::size_t>(std::abs(one.m)));
    }
    Phases x(n_most), y(m_most);
    std::vector<Mode> modes(vectors.size());
    for (std::size_t begin = 0; begin < discs.size(); begin += discs_at_once) {
        const std::size_t n = std::min(discs_at_once, discs.size() - begin);
        for (std::size_t j = 0; j < n; ++j) {
            x.set(j, discs[begin + j].x_at(time) / lx);
            y.set(j, discs[begin + j].y_at(time) / ly);
        }
#pragma omp parallel for num_threads(n_threads) schedule(static)
        for (std::size_t k = 0; k < vectors.size(); ++k) {
            const Mode mode = mode_of(x, y, vectors[k], n, rounder);
            modes[k].real += mode.real;
            modes[k].imaginary += mode.imaginary;
        }
    }
    DensityModes fixed{{}, {}, std::ldexp(1.0, -digits)};
    const auto units = [digits](double part) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::ldexp(part, digits)));
    };
    for (const Mode& mode : modes) {
        fixed.real.push_back(units(mode.real));
        fixed.imaginary.push_back(units(mode.imaginary));
    }
    return fixed;
}

} // namespace carrom
