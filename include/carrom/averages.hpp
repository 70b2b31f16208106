// SPDX-License-Identifier: BSD-3-Clause
// Averages over a run: how often discs collide, the pressure and the speeds, each with a standard
// error.
//
// The averages follow from counts of collisions, which are stored with the discs, and from sums
// over velocities and impulses in fixed point. So they have the same bits for any number of ranks
// and threads. docs/reference/report.md describes them, docs/understanding/pressure.md explains the
// pressure. Wall and virial pressure are computed from counts of collisions (Li, Nishikawa,
// Hoellmer, Carillo, Maggs, Krauth, J. Chem. Phys. 157, 234111 (2022), equations (13c) and (19a)).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace carrom {

/// An average and its standard error, from blocks long enough to be independent. The error is NaN
/// if there are too few blocks or collisions, if the average is conserved, or if it is still
/// changing, because a trend is not an error. All numbers are NaN if nothing is averaged.
struct Estimate {
    double value = std::numeric_limits<double>::quiet_NaN();
    double error = std::numeric_limits<double>::quiet_NaN();
    /// Correlation time in steps. The shortest one that can be measured is half a block.
    double correlation_time = std::numeric_limits<double>::quiet_NaN();
    double independent_samples = std::numeric_limits<double>::quiet_NaN();
    /// Whether there are too few blocks or collisions for a reliable error; `error` is then NaN.
    /// Always false in runs that are planned for less than a million steps.
    bool is_short = false;
    bool is_conserved = false; ///< whether the means of all blocks agree except for rounding
    bool is_changing = false;  ///< the run's halves differ too much, a trend remains, or discs left
    /// Mean over the first block, if the average is changing
    double first = std::numeric_limits<double>::quiet_NaN();
    /// Mean over the last block, if the average is changing
    double last = std::numeric_limits<double>::quiet_NaN();
};

/// A symmetric tensor: xy and yx are equal.
struct TensorEstimate {
    Estimate xx, xy, yy;
};

/// Lengths are in the scene's unit, times in steps; masses are 1 unless the scene gives them.
struct Averages {
    /// The averages begin after `first_step` and cover `steps` steps
    std::int64_t first_step = 0, steps = 0;
    std::int64_t n_blocks = 0;    ///< number of blocks from which errors are computed
    Estimate collision_frequency; ///< collisions with other discs, per disc and step
    /// Mean time between two collisions of a disc with others, in steps; infinite if there are none
    Estimate mean_free_time;
    Estimate wall_pressure;   ///< pressure from collisions with walls, equation (13c)
    Estimate virial_pressure; ///< pressure from collisions with walls and between discs, (19a)
    Estimate mean_speed;
    Estimate speed_kurtosis; ///< <v^4> / <v^2>^2; 2 N / (N + 1) in equilibrium
    Estimate temperature;    ///< kT of translation, relative to the drift along periodic sides
    /// Pressure tensor: the kinetic part, plus the sum over pair collisions of impulse times
    /// distance between the centres, divided by time and area
    TensorEstimate pressure_tensor;
    Estimate pressure;        ///< half of the trace of `pressure_tensor`
    Estimate compressibility; ///< compressibility factor Z = P A / (N kT)

    /// The averages that every run has, with their short names.
    std::array<std::pair<std::string_view, Estimate>, 9> named() const {
        return {{{"collision rate", collision_frequency},
                 {"kT", temperature},
                 {"P", pressure},
                 {"Z", compressibility},
                 {"P_xx", pressure_tensor.xx},
                 {"P_xy", pressure_tensor.xy},
                 {"P_yy", pressure_tensor.yy},
                 {"mean speed", mean_speed},
                 {"kurtosis", speed_kurtosis}}};
    }
};

/// The reason why an average has no error; empty if it has one.
std::string reason_without_error(const Estimate& estimate, const Averages& averages);

} // namespace carrom
