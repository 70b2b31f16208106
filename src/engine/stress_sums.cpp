// SPDX-License-Identifier: BSD-3-Clause
#include "engine/stress_sums.hpp"

#include <cmath>
#include <cstdint>

namespace carrom {

StressSums& StressSums::operator+=(const StressSums& other) {
    for (std::size_t k = 0; k < parts().size(); ++k) *parts()[k] += *other.parts()[k];
    return *this;
}

StressSums& StressSums::operator-=(const StressSums& other) {
    for (std::size_t k = 0; k < parts().size(); ++k) *parts()[k] -= *other.parts()[k];
    return *this;
}

void StressSums::add_flight(double mass, const DiscState& disc, const FlightIntegral& integral) {
    const double vx = disc.vx + integral.shift_x, vy = disc.vy + integral.shift_y,
                 weight = integral.weight;
    const double term_xx = mass * (weight * vx * vx + integral.rest_x * integral.rest_x),
                 term_yy = mass * (weight * vy * vy + integral.rest_y * integral.rest_y +
                                   integral.more_y * integral.more_y);
    xx.add(term_xx);
    xy.add(mass * (weight * vx * vy + integral.rest_x * integral.rest_y));
    yy.add(term_yy);
    energy.add(term_xx + term_yy);
}

/// The sums are the same as if add_impulse were called for each term.
void StressTerms::add_to(StressSums& sum) {
    const double from = unit_shift / sum.xx.scale(), // all three sums have the same bound
        from_twice = 2 * from;
    std::uint64_t xx = 0, xy = 0, yy = 0, changed = 0;
#pragma GCC unroll 4
    for (std::size_t k = 0; k < n_; ++k) {
        const std::uint64_t term_xx = bits_of(ix_[k] * x_[k] + from),
                            term_xy = bits_of(ix_[k] * y_[k] + iy_[k] * x_[k] + from_twice),
                            term_yy = bits_of(iy_[k] * y_[k] + from);
        xx += term_xx;
        xy += term_xy;
        yy += term_yy;
        changed |= (term_xx ^ bits_of(from)) | (term_xy ^ bits_of(from_twice)) |
                   (term_yy ^ bits_of(from));
    }
    // a term that has changed the exponent is too large to be added as an integer
    const bool are_large = changed >> 52 != 0;
    if (are_large || !std::isnormal(from)) {
        add_each(sum);
    } else {
        sum.xx.add_units(static_cast<std::int64_t>(n_ * bits_of(from) - xx));
        sum.xy.add_units(static_cast<std::int64_t>(n_ * bits_of(from_twice) - xy));
        sum.yy.add_units(static_cast<std::int64_t>(n_ * bits_of(from) - yy));
    }
    n_ = 0;
}

/// Adds each term by itself: slower than add_to, with the same bits.
void StressTerms::add_each(StressSums& sum) const {
    for (std::size_t k = 0; k < n_; ++k) add_impulse(sum, ix_[k], iy_[k], {x_[k], y_[k]});
}

} // namespace carrom
