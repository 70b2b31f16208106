// SPDX-License-Identifier: BSD-3-Clause
// The best speeds of this machine, measured together with the program: an in-place stream of 64
// bytes per disc, and arithmetic.
//   machine_peaks stream DISCS PASSES THREADS      ns per disc and pass: each double is read,
//                                                  multiplied, added to, written
//   machine_peaks arithmetic SECONDS               billions of operations a second on one core:
//                                                  "double", then "single"
// Vectors have the widest size of the machine (Highway chooses when the program runs). A fused
// multiply and add is two operations.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "machine_peaks.cpp"
#include "hwy/foreach_target.h" // compiles this file once per instruction set
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void Pass(double* numbers, std::size_t n) {
    const hn::ScalableTag<double> d;
    const auto factor = hn::Set(d, 0.9999999), term = hn::Set(d, 1e-7);
    for (std::size_t k = 0; k < n; k += hn::Lanes(d))
        hn::StoreU(hn::MulAdd(hn::LoadU(d, numbers + k), factor, term), d, numbers + k);
}

/// Chains of fused operations, so many that none waits for another. Returns their sum, so that the
/// compiler cannot remove them.
template <class Real> Real Chains(std::size_t n_rounds) {
    const hn::ScalableTag<Real> d;
    const auto factor = hn::Set(d, Real(0.999)), term = hn::Set(d, Real(0.001));
    auto a = hn::Set(d, Real(1)), b = a, c = a, e = a, f = a, g = a, h = a, i = a, j = a, k = a;
    for (std::size_t round = 0; round < n_rounds; ++round) {
        a = hn::MulAdd(a, factor, term);
        b = hn::MulAdd(b, factor, term);
        c = hn::MulAdd(c, factor, term);
        e = hn::MulAdd(e, factor, term);
        f = hn::MulAdd(f, factor, term);
        g = hn::MulAdd(g, factor, term);
        h = hn::MulAdd(h, factor, term);
        i = hn::MulAdd(i, factor, term);
        j = hn::MulAdd(j, factor, term);
        k = hn::MulAdd(k, factor, term);
    }
    const auto sum = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)),
                             hn::Add(hn::Add(f, g), hn::Add(hn::Add(h, i), hn::Add(j, k))));
    return hn::GetLane(hn::SumOfLanes(d, sum));
}

double ChainsOfDoubles(std::size_t n_rounds) { return Chains<double>(n_rounds); }
double ChainsOfSingles(std::size_t n_rounds) {
    return static_cast<double>(Chains<float>(n_rounds));
}
std::size_t BytesPerVector() { return hn::Lanes(hn::ScalableTag<std::uint8_t>()); }

} // namespace HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

HWY_EXPORT(Pass);
HWY_EXPORT(ChainsOfDoubles);
HWY_EXPORT(ChainsOfSingles);
HWY_EXPORT(BytesPerVector);

namespace {

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// Nanoseconds per disc and pass, over `passes` after a first one that brings the data into memory.
double stream(std::size_t n_discs, int passes, int n_threads) {
    constexpr std::size_t doubles_per_disc = 8;
    const std::size_t n = n_discs * doubles_per_disc,
                      share = n / static_cast<std::size_t>(n_threads) / 64 * 64;
    const std::unique_ptr<double[]> numbers(new double[n + 64]);
    double start = 0;
#pragma omp parallel num_threads(n_threads)
    for (int pass = -1; pass < passes; ++pass) {
#pragma omp barrier
#pragma omp master
        if (pass == 0) start = now();
#pragma omp for schedule(static)
        for (int part = 0; part < n_threads; ++part) {
            double* const begin = numbers.get() + static_cast<std::size_t>(part) * share;
            if (pass < 0)
                std::memset(begin, 0, share * sizeof(double));
            else
                HWY_DYNAMIC_DISPATCH(Pass)(begin, share);
        }
    }
    return (now() - start) * 1e9 / static_cast<double>(passes) /
           (static_cast<double>(share) * n_threads / doubles_per_disc);
}

/// Measures billions of operations a second.
template <class Chains>
double arithmetic(const Chains& chains, double seconds, std::size_t bytes_per_number) {
    constexpr std::size_t n_rounds = 1 << 20;
    std::size_t n_calls = 0;
    double sum = 0;
    const double start = now();
    while (now() - start < seconds) {
        sum += chains(n_rounds);
        ++n_calls;
    }
    const double elapsed = now() - start;
    if (sum == 0) std::abort(); // never true, but the compiler does not know that
    const auto lanes = static_cast<double>(HWY_DYNAMIC_DISPATCH(BytesPerVector)() /
                                           bytes_per_number);
    return static_cast<double>(n_calls * n_rounds) * 10 * 2 * lanes / elapsed / 1e9;
}

} // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "stream" && argc == 5) {
        std::printf("%.4f\n", stream(std::stoul(argv[2]), std::stoi(argv[3]), std::stoi(argv[4])));
    } else if (what == "arithmetic" && argc == 3) {
        const double seconds = std::stod(argv[2]) / 2;
        std::printf(
            "double %.2f\n",
            arithmetic([](std::size_t n) { return HWY_DYNAMIC_DISPATCH(ChainsOfDoubles)(n); },
                       seconds, sizeof(double)));
        std::printf(
            "single %.2f\n",
            arithmetic([](std::size_t n) { return HWY_DYNAMIC_DISPATCH(ChainsOfSingles)(n); },
                       seconds, sizeof(float)));
    } else {
        std::fprintf(
            stderr,
            "machine_peaks stream DISCS PASSES THREADS | machine_peaks arithmetic SECONDS\n");
        return 2;
    }
    return 0;
}

#endif
