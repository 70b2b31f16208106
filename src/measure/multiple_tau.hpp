// SPDX-License-Identifier: BSD-3-Clause
// Chooses the pairs of samples for a correlation over decades of time: the multiple-tau scheme of
// Ramirez and others, J. Chem. Phys. 133, 154103 (2010), without its averages over time.
//
// Level l stores every 2^l-th sample, and keeps the latest `points` of them. Level 0 has lags of 1
// to `points` samples. Further levels have lags of 2^l n samples, with n from points / 2 + 1 to
// `points`. Each stored sample is an origin, so origins overlap. Lags can be as long as the run,
// memory grows with the logarithm of its length, and a sample is compared with 1.5 times `points`
// earlier ones on average. Ramirez averages the samples that a level skips, which blurs lags. Here
// these samples are left out, because displacements need exact lags.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "scene/quantity.hpp"

namespace carrom {

/// The setting for `points`, which all quantities with correlations over decades of time share.
inline constexpr QuantitySetting correlation_points{"correlation_points", 8};
Key correlation_points_key();
void check_correlation_points(const SceneDraft& draft);
/// Warns if a run is too short for any lag. That is not an error, because a restart may continue
/// the run.
void warn_without_lags(const SceneDraft& draft);

class MultipleTau {
public:
    /// `points` must be a power of two and at least 2.
    explicit MultipleTau(std::uint64_t points) : points_(points) {}

    std::uint64_t points() const { return points_; }
    /// The number of levels in use at sample `n`; the first sample has the number 0.
    std::size_t n_levels(std::uint64_t n) const {
        const std::uint64_t half = points_ / 2;
        return n < half ? 1 : static_cast<std::size_t>(std::bit_width(n / half));
    }
    /// Whether level `level` comes into use at sample `n`.
    bool begins(std::size_t level, std::uint64_t n) const {
        return level > 0 && n == (points_ / 2) << level;
    }
    std::size_t n_lags(std::uint64_t n) const { return points_ + (n_levels(n) - 1) * points_ / 2; }
    /// The length of the lag with this index, in samples.
    std::uint64_t lag(std::size_t index) const {
        if (index < points_) return index + 1;
        const std::uint64_t half = points_ / 2, beyond = index - points_;
        return (half + 1 + beyond % half) << (1 + beyond / half);
    }
    bool keeps(std::size_t level, std::uint64_t n) const {
        return (n & ((std::uint64_t{1} << level) - 1)) == 0;
    }
    std::size_t slot(std::size_t level, std::uint64_t n) const {
        return static_cast<std::size_t>((n >> level) % points_);
    }
    /// Calls `act(lag's index, level, slot)` for each earlier sample with which sample `n` is
    /// compared. Call it before sample `n` is stored in its own slots.
    template <class Act> void for_each_pair(std::uint64_t n, const Act& act) const {
        for (std::size_t level = 0; level < n_levels(n) && keeps(level, n); ++level) {
            const std::uint64_t first = level == 0 ? 1 : points_ / 2 + 1, kept = n >> level;
            for (std::uint64_t back = first; back <= points_ && back <= kept; ++back)
                act(level == 0 ? back - 1
                               : points_ + (level - 1) * points_ / 2 + (back - points_ / 2 - 1),
                    level, static_cast<std::size_t>((kept - back) % points_));
        }
    }

private:
    std::uint64_t points_;
};

} // namespace carrom
