// SPDX-License-Identifier: BSD-3-Clause
// How the motion of discs over a lag depends on the waiting time, which is the time from the first
// sample to the lag's origin. In equilibrium nothing depends on it. A glass ages: discs
// become slower as the waiting time grows.
//
// Origins are averaged over octaves of the waiting time, counted in samples: 0, 1, 2 to 3, 4 to 7,
// and so on. The pairs of samples are those that multiple_tau.hpp compares anyway, so no further
// comparisons are needed. Memory: at most 3 kB for each octave, lag and species. A run of a million
// samples has some 650 combinations of an octave and a lag.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <carrom/measured_table.hpp>

#include "measure/kept_numbers.hpp"
#include "measure/multiple_tau.hpp"
#include "statistics/blocking.hpp"

namespace carrom {

/// Means over the discs of one kind, for one origin and lag: the mean squared displacement, F_s,
/// and the share of discs that have moved less than the overlap distance.
struct MovedDiscs {
    double squares = 0, scattering = 0, overlap = 0;
};

class WaitingTimes {
public:
    /// `n_kinds` is the number of kinds of discs (species, and all discs) that have means of their
    /// own.
    explicit WaitingTimes(std::size_t n_kinds = 1) : n_kinds_(n_kinds) {}

    /// Adds the values for the lag with the number `lag` and the origin at sample number `origin`.
    /// `moved` has one entry for each kind of discs: the means over that kind.
    void add(std::size_t lag, std::uint64_t origin, std::span<const MovedDiscs> moved);
    void keep(KeptNumbers& kept);
    /// A table of the means of one kind, with a row for each octave and lag.
    MeasuredTable table(std::string name, std::size_t kind, const MultipleTau& scheme,
                        std::int64_t steps_per_sample) const;
    /// Compares the scattering function F_s of the earliest origins with F_s of late origins, which
    /// are in octaves that begin after the first quarter of the run.
    struct Comparison {
        double early = 0, late = 0;
        std::uint64_t late_from = 0; ///< first sample of the late origins
        double deviation = 0;        ///< difference divided by its error; 0 if the error is unknown
    };
    /// `length` is the lag in samples. The earliest origins lie within a quarter of a lag, so they
    /// count as a single independent origin. Late origins count as one independent origin for every
    /// two lags of time. The variance of an independent origin is taken to be the variance over all
    /// late origins.
    Comparison compare(std::size_t lag, std::size_t kind, std::uint64_t length,
                       std::uint64_t n_samples) const;

private:
    /// Number of values for each kind: the members of MovedDiscs and the square of `scattering`
    static constexpr std::size_t n_numbers = 4;
    /// Sums over origins, for one kind of discs.
    struct Sums {
        double n = 0, scattering = 0, squared_scattering = 0;
    };

    void add_octave(std::size_t octave, std::size_t lag, std::size_t kind, Sums& sums) const;
    VectorBlocks& cell(std::size_t octave, std::size_t lag);

    std::size_t n_kinds_;
    std::vector<std::vector<VectorBlocks>> octaves_; ///< means, by octave and then by lag
};

} // namespace carrom
