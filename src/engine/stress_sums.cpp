// SPDX-License-Identifier: BSD-3-Clause
#include "engine/stress_sums.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace carrom {

namespace {

/// A number of less than 2^51 units that is added to this constant leaves its nearest
/// integer in the last bits. The bits of such sums can be added up as integers, in vectors.
constexpr double shift = 0x1.8p52;
constexpr double most_units = 0x1p51;

std::uint64_t bits(double number) { return std::bit_cast<std::uint64_t>(number); }

} // namespace

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

void StressTerms::add_flight(double mass, const DiscState& disc, const FlightIntegral& integral,
                             StressSums& sum) {
    const double vx = disc.vx + integral.shift_x, vy = disc.vy + integral.shift_y;
    add(-mass * vx, -mass * vy, {integral.weight * vx, integral.weight * vy}, sum);
    if (integral.rest_x != 0 || integral.rest_y != 0)
        add(-mass * integral.rest_x, -mass * integral.rest_y, {integral.rest_x, integral.rest_y},
            sum);
    if (integral.more_y != 0) add(0, -mass * integral.more_y, {0, integral.more_y}, sum);
}

/// The sum counts the mean of xy and yx, because rough discs make them differ.
void StressTerms::add_to(StressSums& sum) {
    const double from = shift / sum.xx.scale(), // all three sums have one bound
        from_twice = 2 * from;
    std::uint64_t xx = 0, xy = 0, yy = 0, changed = 0;
#pragma GCC unroll 4
    for (std::size_t k = 0; k < n_; ++k) {
        const std::uint64_t term_xx = bits(ix_[k] * x_[k] + from),
                            term_xy = bits(ix_[k] * y_[k] + iy_[k] * x_[k] + from_twice),
                            term_yy = bits(iy_[k] * y_[k] + from);
        xx += term_xx;
        xy += term_xy;
        yy += term_yy;
        changed |= (term_xx ^ bits(from)) | (term_xy ^ bits(from_twice)) | (term_yy ^ bits(from));
    }
    const bool are_large = changed >> 52 != 0; // an exponent is not that of the constant
    if (are_large || !std::isnormal(from)) {
        add_each(sum);
    } else {
        sum.xx.add_units(static_cast<std::int64_t>(n_ * bits(from) - xx));
        sum.xy.add_units(static_cast<std::int64_t>(n_ * bits(from_twice) - xy));
        sum.yy.add_units(static_cast<std::int64_t>(n_ * bits(from) - yy));
    }
    n_ = 0;
}

/// Gives the same bits as add_to, one term after the other.
void StressTerms::add_each(StressSums& sum) const {
    const auto add_one = [](ExactSum& part, double term) {
        const double units = term * part.scale();
        if (std::fabs(units) < most_units)
            part.add_units(static_cast<std::int64_t>(bits(shift) - bits(shift + units)));
        else
            part.add(-term);
    };
    for (std::size_t k = 0; k < n_; ++k) {
        add_one(sum.xx, ix_[k] * x_[k]);
        add_one(sum.xy, 0.5 * (ix_[k] * y_[k] + iy_[k] * x_[k]));
        add_one(sum.yy, iy_[k] * y_[k]);
    }
}

} // namespace carrom
