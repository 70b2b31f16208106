// SPDX-License-Identifier: BSD-3-Clause
#include "core/rounded_sine.hpp"

#include <cmath>

namespace carrom {

namespace {

/// A number as the sum of two doubles. `low` is at most half a unit in the last place of `high`.
struct Pair {
    double high = 0, low = 0;
};

/// a + b without error, if |a| is at least |b| (Dekker, Numer. Math. 18, 224 (1971)).
Pair sum_of_ordered(double a, double b) {
    const double sum = a + b;
    return {sum, b - (sum - a)};
}

/// a + b without error (Knuth, The Art of Computer Programming 2, section 4.2.2).
Pair exact_sum(double a, double b) {
    const double sum = a + b, b_part = sum - a;
    return {sum, (a - (sum - b_part)) + (b - b_part)};
}

Pair add(Pair a, Pair b) {
    const Pair high = exact_sum(a.high, b.high), low = exact_sum(a.low, b.low);
    const Pair sum = sum_of_ordered(high.high, high.low + low.high);
    return sum_of_ordered(sum.high, sum.low + low.low);
}

Pair multiply(Pair a, Pair b) {
    const double high = a.high * b.high, rest = std::fma(a.high, b.high, -high);
    return sum_of_ordered(high, rest + (a.high * b.low + a.low * b.high));
}

Pair divide(Pair a, double b) {
    const double high = a.high / b, rest = std::fma(-high, b, a.high);
    return sum_of_ordered(high, (rest + a.low) / b);
}

/// pi / 2 in three doubles: 161 bits.
constexpr double half_pi[] = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110};

/// The Taylor series of sin(x) if `first` is 1, of cos(x) if it is 0. Neglected terms are below
/// 2^-107 for |x| <= pi/4.
Pair series(Pair x, int first) {
    const Pair square = multiply(x, x);
    Pair sum{1, 0};
    for (int n = first + 26; n > first; n -= 2) {
        const Pair term = divide(multiply(sum, square), -static_cast<double>(n * (n - 1)));
        sum = add({1, 0}, term);
    }
    return first == 1 ? multiply(sum, x) : sum;
}

} // namespace

RoundedSine rounded_sine(double angle) {
    const double quarters = std::floor(angle / half_pi[0] + 0.5);
    // The product of pi / 2 and `quarters` has too many bits for a double; high + rest is exact.
    const double high = quarters * half_pi[0], rest = std::fma(quarters, half_pi[0], -high);
    Pair x = exact_sum(angle, -high);
    x = add(x, {-rest, 0});
    x = add(x, {-quarters * half_pi[1], -std::fma(quarters, half_pi[1], -(quarters * half_pi[1]))});
    x = add(x, {-quarters * half_pi[2], 0});
    const double sine = series(x, 1).high, cosine = series(x, 0).high;
    switch (static_cast<int>(quarters) & 3) {
    case 0: return {sine, cosine};
    case 1: return {cosine, -sine};
    case 2: return {-sine, -cosine};
    default: return {-cosine, sine};
    }
}

} // namespace carrom
