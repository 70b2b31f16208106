// SPDX-License-Identifier: BSD-3-Clause
// The error of the predicate relative to its bounds, computed in quad precision.
//
// The bound for the discriminant, 10 u (1 + A sigma^2/disc), is the sum of its rounding errors:
// sqrt(A) sigma has a relative error of 3 u (two in A, halved by the root, then the root itself and
// the product), the cross product one of 2 u. Near a graze their difference is exact and their sum
// is twice either: (3 + 2) x 2. Random cases reach 8.9.
#pragma once

#include "catch.hpp"

#include <algorithm>
#include <cmath>

#include "approach.hpp"
#include "dynamics/pair_contact.hpp"
#include "quad.hpp"

namespace carrom::test {

inline constexpr double u = 0x1p-53;
// in diameters, because the cases overlap by a few ulp only
inline constexpr double deepest = 1e-12;

inline double delay_of(const Approach& c) {
    return contact_delay(c.dx, c.dy, c.wx, c.wy, c.sigma, deepest * c.sigma);
}

inline double discriminant_of(const Approach& c) {
    const double reach = std::sqrt(c.wx * c.wx + c.wy * c.wy) * c.sigma;
    const double x = std::fabs(cross(c.dx, c.dy, c.wx, c.wy));
    return (reach - x) * (reach + x);
}

/// The errors of a case divided by their bounds; a ratio above 1 is a failure.
struct Verdict {
    double delay_ratio = 0, discriminant_ratio = 0, cross_ratio = 0;
    bool is_hit = false, is_missed = false, is_invented = false;
};

inline Verdict judge(const Approach& c) {
    const EventContact exact(c.dx, c.dy, c.wx, c.wy, c.sigma);
    const double delay = delay_of(c);
    const Quad reach_square = exact.a * c.sigma * c.sigma;
    Verdict verdict;
    verdict.is_hit = delay >= 0;
    // If a pair overlaps by some ulp and moves along the tangent, even the sign of b is uncertain.
    const bool b_is_unclear = exact.distance < c.sigma &&
                              -exact.b < 2 * u * exact.distance * square_root(exact.a);
    verdict.is_missed = exact.delay >= 0 && exact.discriminant > 16 * u * reach_square &&
                        !b_is_unclear && delay < 0;
    verdict.is_invented = delay >= 0 &&
                          (exact.discriminant < -16 * u * reach_square || exact.b > 0);

    const Quad terms = absolute(Quad(c.dx) * c.wy) + absolute(Quad(c.dy) * c.wx);
    const Quad cross_bound = 3 * u * absolute(exact.cross) + 4 * u * u * terms;
    const Quad cross_error = absolute(Quad(cross(c.dx, c.dy, c.wx, c.wy)) - exact.cross);
    verdict.cross_ratio = static_cast<double>(cross_error / cross_bound);
    if (exact.discriminant <= 0) return verdict;

    const Quad condition = exact.condition(c.sigma);
    const Quad discriminant_error = absolute(Quad(discriminant_of(c)) - exact.discriminant) /
                                    exact.discriminant;
    verdict.discriminant_ratio = static_cast<double>(discriminant_error /
                                                     (10 * u * (1 + condition)));
    if (delay < 0 || exact.delay < 0) return verdict;
    const Quad bound = 16 * u * (exact.distance + c.sigma * square_root(condition)) /
                       square_root(exact.a);
    verdict.delay_ratio = static_cast<double>(absolute(Quad(delay) - exact.delay) / bound);
    return verdict;
}

struct Worst {
    double delay_ratio = 0, discriminant_ratio = 0, cross_ratio = 0;
    int hits = 0, missed = 0, invented = 0;

    void take(const Verdict& verdict) {
        delay_ratio = std::max(delay_ratio, verdict.delay_ratio);
        discriminant_ratio = std::max(discriminant_ratio, verdict.discriminant_ratio);
        cross_ratio = std::max(cross_ratio, verdict.cross_ratio);
        hits += verdict.is_hit;
        missed += verdict.is_missed;
        invented += verdict.is_invented;
    }

    void check(int fewest_hits) const {
        CAPTURE(delay_ratio, discriminant_ratio, cross_ratio, hits);
        CHECK(hits >= fewest_hits);
        CHECK(missed == 0);
        CHECK(invented == 0);
        CHECK(delay_ratio <= 1);
        CHECK(discriminant_ratio <= 1);
        CHECK(cross_ratio <= 1);
    }
};

} // namespace carrom::test
