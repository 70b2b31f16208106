// SPDX-License-Identifier: BSD-3-Clause
// The size of a disc that meets a fixed body (fixed_bodies.hpp).
#pragma once

namespace carrom {

/// The radius of a disc at the time of its state, and the rate at which it grows.
struct DiscSize {
    double radius = 0, rate = 0;

    double after(double delay) const { return radius + rate * delay; }
    /// The growth rate of `reach`, a distance that grows as fast as the radius, divided by `reach`.
    double rate_of(double reach) const { return rate == 0 ? 0 : rate / reach; }
};

} // namespace carrom
