// SPDX-License-Identifier: BSD-3-Clause
// How discs move by the time that has passed before the origin of a lag: the waiting time. In
// equilibrium nothing depends on it. A glass ages: the longer it has waited, the slower its discs.
//
// Origins are joined by octaves of the waiting time, counted in samples: 0, 1, 2 to 3, 4 to 7, and
// so on. They are those pairs of samples that multiple_tau.hpp compares anyway, so there is no more
// work for discs. Memory: at most 3 kB for each octave, lag and species, and a run of a million
// samples has some 650 pairs of an octave and a lag.
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

/// Means over discs at one origin, of one kind of discs.
struct MovedDiscs {
    double squares = 0, scattering = 0, overlap = 0;
};

class WaitingTimes {
public:
    /// `n_kinds`: for how many kinds of discs each origin has means.
    explicit WaitingTimes(std::size_t n_kinds = 1) : n_kinds_(n_kinds) {}

    /// Adds an origin, which is the sample with that number. `moved` has all kinds.
    void add(std::size_t lag, std::uint64_t origin, std::span<const MovedDiscs> moved);
    void keep(KeptNumbers& kept);
    /// One row for each octave and lag of that kind.
    MeasuredTable table(std::string name, std::size_t kind, const MultipleTau& scheme,
                        std::int64_t steps_per_sample) const;
    /// Compares F_s of the earliest origins with that of origins in the second half of the run, or
    /// more than that half.
    struct Comparison {
        double early = 0, late = 0;
        std::uint64_t late_from = 0; ///< in samples
        double deviation = 0;        ///< the difference over its error; 0 if that is not known
    };
    /// `length`: the lag's, in samples. The earliest origins lie within a quarter of it, so they
    /// count as one. Late ones count as one in two lengths, and their variance is that of one.
    Comparison compare(std::size_t lag, std::size_t kind, std::uint64_t length,
                       std::uint64_t n_samples) const;

private:
    static constexpr std::size_t n_numbers = 4; ///< those of MovedDiscs, and scattering squared
    /// Sums of numbers of one kind.
    struct Sums {
        double n = 0, scattering = 0, squared_scattering = 0;
    };

    void add_octave(std::size_t octave, std::size_t lag, std::size_t kind, Sums& sums) const;
    VectorBlocks& cell(std::size_t octave, std::size_t lag);

    std::size_t n_kinds_;
    std::vector<std::vector<VectorBlocks>> octaves_; ///< by octave, then by lag
};

} // namespace carrom
