// SPDX-License-Identifier: BSD-3-Clause
// The two walls at rest that limit one coordinate of a disc's centre. `Real` is double, or float
// for the accuracy study.
//
// In the time-stepped method the position of the disc at the end of micro-step m determines whether
// it bounces off the wall ahead. A slow disc that is within a narrow band along the wall at the end
// of the micro-step bounces then without a contact, because rounding might otherwise keep it there
// for ever.
#pragma once

#include <algorithm>
#include <limits>

#include "core/device.hpp"

namespace carrom {

template <class Real> class RestingWalls {
public:
    static constexpr Real never = std::numeric_limits<Real>::infinity();

    /// `radius` is the disc's radius; `band` is the width of the band in which a slow disc bounces.
    CARROM_DEVICE RestingWalls(Real length, Real radius, Real band)
        : low_(radius), high_(length - radius), band_(band) {}

    CARROM_DEVICE Real low() const { return low_; }
    CARROM_DEVICE Real high() const { return high_; }

    /// Time-stepped method: the time of the bounce within micro-step m, from 0 to 1, or `never`.
    /// The disc is at x at its own time tau.
    [[gnu::always_inline]] CARROM_DEVICE Real time(Real x, Real v, Real tau, Real m) const {
        const Real at_end = x + v * ((m + 1) - tau);
        if (v < 0 && at_end < low_ + band_)
            return std::clamp((tau - m) + (low_ - x) / v, Real{0}, Real{1});
        if (v > 0 && at_end > high_ - band_)
            return std::clamp((tau - m) + (high_ - x) / v, Real{0}, Real{1});
        return never;
    }

    /// Whether the disc is in the band of the wall towards which it flies, or beyond this wall.
    CARROM_DEVICE bool touches(Real x, Real v) const {
        return (v < 0 && x <= low_ + band_) || (v > 0 && x >= high_ - band_);
    }

    /// The time within the `rest` of a micro-step at which the disc would leave the box, or
    /// `never`.
    [[gnu::always_inline]] CARROM_DEVICE Real stop(Real x, Real v, Real rest) const {
        const Real at_end = x + v * rest;
        if (v < 0 && at_end < low_) return std::max((low_ - x) / v, Real{0});
        if (v > 0 && at_end > high_) return std::max((high_ - x) / v, Real{0});
        return never;
    }

    /// Event-driven method: the time until the disc reaches the wall ahead, or `never`.
    CARROM_DEVICE Real delay(Real x, Real v) const {
        if (v == 0) return never;
        const Real delay = ((v < 0 ? low_ : high_) - x) / v;
        return delay > 0 ? delay : 0;
    }

private:
    Real low_, high_, band_;
};

} // namespace carrom
