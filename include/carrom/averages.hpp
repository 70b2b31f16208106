// SPDX-License-Identifier: BSD-3-Clause
// Averages over a run: how often discs collide, the pressure, the speeds, each with a standard
// error.
//
// All follow from counts of collisions, which every disc carries, and from sums over velocities
// and impulses in fixed point. So they are the same bits for any number of ranks and threads.
// docs/reference/report.md says what they mean, docs/understanding/pressure.md what the pressure
// is. Sources of wall and virial pressure, which follow from counts: Li, Nishikawa, Hoellmer,
// Carillo, Maggs, Krauth, J. Chem. Phys. 157, 234111 (2022), equations (13c) and (19a).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

namespace carrom {

/// The error is one standard error of the mean, by blocks that are long enough to be independent.
/// It is NaN where there are too few blocks, where the average is conserved, and where it is still
/// changing, because a trend is not an error. All are NaN where nothing is averaged.
struct Estimate {
    double value = std::numeric_limits<double>::quiet_NaN();
    double error = std::numeric_limits<double>::quiet_NaN();
    /// In steps; half a block is the shortest that can be seen.
    double correlation_time = std::numeric_limits<double>::quiet_NaN();
    double independent_samples = std::numeric_limits<double>::quiet_NaN();
    bool is_conserved = false; ///< all blocks have the same value but for rounding
    bool is_changing = false;  ///< the halves of the run differ by more than errors allow
    double first = std::numeric_limits<double>::quiet_NaN(); ///< of the first block, if it changes
    double last = std::numeric_limits<double>::quiet_NaN();  ///< of the last block, if it changes
};

/// The same both ways along x and y.
struct TensorEstimate {
    Estimate xx, xy, yy;
};

/// Lengths in the scene's unit, times in steps, masses 1.
struct Averages {
    std::int64_t first_step = 0, steps = 0; ///< what they are averages over
    std::int64_t n_blocks = 0;              ///< that the errors rest on
    Estimate collision_frequency;           ///< collisions with other discs, per disc and step
    Estimate mean_free_time;  ///< steps between two of them; infinite if there are none
    Estimate wall_pressure;   ///< from collisions with walls, (13c)
    Estimate virial_pressure; ///< from collisions with walls and of pairs, (19a)
    Estimate mean_speed;
    Estimate speed_kurtosis;        ///< <v^4> / <v^2>^2; 2 N / (N + 1) in equilibrium
    Estimate temperature;           ///< kT of translation, without a drift along periodic sides
    TensorEstimate pressure_tensor; ///< kinetic part, and impulse times distance of pairs
    Estimate pressure;              ///< half its trace
    Estimate compressibility;       ///< P A / (N kT)

    /// Those that every run has, with short names.
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

} // namespace carrom
