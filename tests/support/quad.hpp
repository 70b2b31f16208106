// SPDX-License-Identifier: BSD-3-Clause
// Numbers of 113 bits, a standard for tests of predicates, because they hold products of two
// doubles exactly.
//
// GCC and Clang have them as __float128, or as long double if that has 113 bits. The square root
// uses Newton's rule, so no library is needed.
#pragma once

#include <cfloat>
#include <cmath>

namespace carrom::test {

#if LDBL_MANT_DIG >= 113
using Quad = long double;
#else
__extension__ using Quad = __float128;
#endif

inline Quad absolute(Quad value) { return value < 0 ? -value : value; }

/// The square root, to within about 2^-111. Arguments may lie beyond the range of a double.
inline Quad square_root(Quad value) {
    if (value <= 0) return 0;
    Quad scale = 1;
    for (; value < Quad(0x1p-400); value *= Quad(0x1p400)) scale *= Quad(0x1p-200);
    for (; value > Quad(0x1p400); value *= Quad(0x1p-400)) scale *= Quad(0x1p200);
    Quad root = std::sqrt(static_cast<double>(value));
    for (int i = 0; i < 3; ++i) root = (root + value / root) / 2;
    return root * scale;
}

/// Taylor's series of the sine of x if `first` is 1, of its cosine if it is 0. It needs neither pi
/// nor a reduction of the angle. Some 100 bits are right for |x| <= 7: the largest term is 164.
inline Quad sine_series(double x, int first) {
    Quad term = first == 1 ? Quad(x) : Quad(1), sum = term;
    for (int n = first + 2; n < first + 80; n += 2) {
        term *= -Quad(x) * Quad(x) / Quad(n * (n - 1));
        sum += term;
    }
    return sum;
}

/// The doubles nearest to the sine and to the cosine.
inline double nearest_sine(double x) { return static_cast<double>(sine_series(x, 1)); }
inline double nearest_cosine(double x) { return static_cast<double>(sine_series(x, 0)); }

/// A contact computed in quad precision from the same doubles as in the predicate.
struct EventContact {
    Quad b, a, distance, cross, discriminant;
    Quad delay = -1; ///< negative if there is none; 0 if discs touch or overlap and approach

    EventContact(double dx, double dy, double wx, double wy, double sigma) {
        b = Quad(dx) * wx + Quad(dy) * wy;
        a = Quad(wx) * wx + Quad(wy) * wy;
        cross = Quad(dx) * wy - Quad(dy) * wx;
        distance = square_root(Quad(dx) * dx + Quad(dy) * dy);
        discriminant = a * sigma * sigma - cross * cross;
        if (b >= 0 || discriminant <= 0) return;
        const Quad c = (Quad(dx) * dx - Quad(sigma) * sigma) + Quad(dy) * dy;
        delay = c <= 0 ? Quad(0) : c / (-b + square_root(discriminant));
    }

    /// A sigma^2 / disc, the condition number of the contact, which is large for grazes.
    Quad condition(double sigma) const { return a * sigma * sigma / discriminant; }
};

} // namespace carrom::test
