// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pair_virial.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace carrom {

namespace {

/// A number of less than 2^51 units that is added to this many leaves its nearest integer in the
/// last bits. Bits of such sums can be added up as integers, in vectors.
constexpr double shift = 0x1.8p52;
constexpr double most_units = 0x1p51;

std::uint64_t bits(double number) { return std::bit_cast<std::uint64_t>(number); }

} // namespace

/// The mean of xy and yx counts: rough discs make them differ.
void VirialTerms::add_to(PairVirial& sum) {
    const double from = shift / sum.xx.scale(), // of all three: they have one bound
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
    const bool are_large = changed >> 52 != 0; // an exponent is not that of the shift
    if (are_large || !std::isnormal(from)) {
        add_each(sum);
    } else {
        sum.xx.add_units(static_cast<std::int64_t>(n_ * bits(from) - xx));
        sum.xy.add_units(static_cast<std::int64_t>(n_ * bits(from_twice) - xy));
        sum.yy.add_units(static_cast<std::int64_t>(n_ * bits(from) - yy));
    }
    n_ = 0;
}

/// To the same bits.
void VirialTerms::add_each(PairVirial& sum) const {
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
