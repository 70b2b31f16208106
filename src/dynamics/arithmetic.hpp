// SPDX-License-Identifier: BSD-3-Clause
// The arithmetic of flights and contacts: double precision and the stable formula for the time of
// contact (pair_contact.hpp). It is one part of a dynamics (dynamics.hpp). The accuracy study uses
// other arithmetics (studied_arithmetic.hpp).
#pragma once

#include <algorithm>

#include <carrom/box.hpp>

#include "core/device.hpp"
#include "core/disc_state.hpp"
#include "dynamics/encounter.hpp"
#include "dynamics/pair_contact.hpp"

namespace carrom {

enum class ContactFormula { stable, naive, naive_contracted };

class StableArithmetic {
public:
    using Real = double;
    using State = const DiscState&;
    // True for the accuracy study, in which states are rounded and contacts may be missed
    static constexpr bool is_for_study = false;
    static constexpr double cascade_interval = 0, time_rounding = 0x1p-50;

    StableArithmetic() = default;
    StableArithmetic(const Box& /*box*/, double /*radius*/, ContactFormula /*formula*/) {}

    static Box rounded(const Box& box) { return box; }
    static constexpr double rounded(double number) { return number; }
    /// The deepest overlap that rounding can cause.
    static double tolerance(const Box& box, double diameter) {
        return std::max(1e-12 * diameter, 16 * 0x1p-52 * box.longest());
    }
    /// Half the largest gap that the rounding of positions leaves between two discs at a contact.
    static constexpr double slack() { return 0; }
    static constexpr double place_rounding() { return 0; }
    /// Whether overlapping discs collide if they approach each other.
    static constexpr bool parts_overlaps() { return true; }

    CARROM_DEVICE static void advance(DiscState& disc, double time) {
        const double x = disc.x_at(time), y = disc.y_at(time);
        disc.x = x;
        disc.y = y;
        disc.tau = time;
    }
    [[gnu::always_inline]] CARROM_DEVICE static double delay(const Encounter<double>& met,
                                                             double sigma, double deepest_overlap) {
        return contact_delay(met.ex, met.ey, met.wx, met.wy, sigma, deepest_overlap);
    }
    /// Whether a contact found by the formula is accepted.
    CARROM_DEVICE static constexpr bool counts(const DiscState& /*p*/, const DiscState& /*q*/,
                                               const PairContact<double>& /*found*/) {
        return true;
    }
};

} // namespace carrom
