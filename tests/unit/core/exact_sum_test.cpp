// SPDX-License-Identifier: BSD-3-Clause
// The sum compared with Shewchuk's expansions, which are lists of doubles that contain a sum
// exactly.
#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "core/exact_sum.hpp"

using namespace carrom;

namespace {

double sum_of(const std::vector<double>& terms, double bound) {
    ExactSum sum(bound);
    for (const double term : terms) sum.add(term);
    return sum.value();
}

double bound_of(const std::vector<double>& terms) {
    double bound = 0;
    for (const double term : terms) bound += std::fabs(term);
    return 2 * bound;
}

/// Terms of many magnitudes and both signs, so that the order of an ordinary sum would matter.
std::vector<double> mixed_terms(std::size_t count, int lowest_exponent, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::vector<double> terms;
    for (std::size_t i = 0; i < count; ++i) {
        const double fraction = static_cast<double>(engine() >> 11) * 0x1p-52 - 1;
        terms.push_back(std::ldexp(fraction, lowest_exponent + static_cast<int>(engine() % 60)));
    }
    return terms;
}

/// Exact except for the rounding of the last few additions, whose terms do not overlap.
double careful_sum(const std::vector<double>& terms) {
    std::vector<double> parts;
    for (double term : terms) {
        std::vector<double> rest;
        for (const double part : parts) {
            const double sum = term + part;
            const double back = sum - term;
            const double error = (term - (sum - back)) + (part - back);
            if (error != 0) rest.push_back(error);
            term = sum;
        }
        rest.push_back(term);
        parts = rest;
    }
    double total = 0;
    for (const double part : parts) total += part;
    return total;
}

} // namespace

TEST_CASE("a sum has the same bits in any order and any split") {
    for (const int exponent : {-40, 0, 200, -300}) {
        std::vector<double> terms = mixed_terms(2000, exponent, 3);
        const double bound = bound_of(terms);
        const double expected = sum_of(terms, bound);
        std::mt19937_64 engine(4);
        for (int trial = 0; trial < 20; ++trial) {
            std::shuffle(terms.begin(), terms.end(), engine);
            CHECK(sum_of(terms, bound) == expected);
            const auto cut = terms.begin() + static_cast<std::ptrdiff_t>(engine() % terms.size());
            ExactSum first(bound), second(bound), words(bound);
            for (auto term = terms.begin(); term != cut; ++term) first.add(*term);
            for (auto term = cut; term != terms.end(); ++term) second.add(*term);
            words.add_words(second.low_word(), second.high_word());
            words.add_words(first.low_word(), first.high_word());
            first += second;
            CHECK(first.value() == expected);
            CHECK(words.value() == expected);
        }
    }
}

TEST_CASE("a sum is the exact one to within 2^-125 of the bound a term") {
    for (const int exponent : {-40, 0, 200, -300}) {
        const std::vector<double> terms = mixed_terms(2000, exponent, 5);
        const double bound = bound_of(terms);
        const double exact = careful_sum(terms);
        CHECK(std::fabs(sum_of(terms, bound) - exact) <=
              2000 * 0x1p-125 * bound + 0x1p-53 * std::fabs(exact));
    }
}

TEST_CASE("a sum that cancels leaves what is left") {
    CHECK(sum_of({1e16, 1, -1e16}, 4e16) == 1);
    CHECK(sum_of({1, 1e-16, -1, 3e-16}, 4) == 1e-16 + 3e-16);
    CHECK(sum_of({0x1p100, 3, -0x1p100}, 0x1p102) == 3);
}

TEST_CASE("signs, zeros and one term") {
    CHECK(sum_of({}, 1) == 0);
    CHECK(sum_of({-0.75}, 1) == -0.75);
    CHECK(sum_of({0.1}, 1) == 0.1);
    CHECK(sum_of({-0.1, -0.2, 0.0, -0.0}, 1) == -(0.1 + 0.2));
    CHECK(sum_of({0.0, 0.0}, 0) == 0);
}

TEST_CASE("a sum at its bound does not overflow") {
    CHECK(sum_of(std::vector<double>(1024, 1.0), 1024) == 1024);
    CHECK(sum_of(std::vector<double>(1024, -1.0), 1024) == -1024);
    CHECK(sum_of({0x1.fffffffffffffp+9}, 0x1.fffffffffffffp+9) == 0x1.fffffffffffffp+9);
    CHECK(sum_of({1e300, 1e300}, 4e300) == 2e300);
    CHECK(sum_of({1e-300, -3e-300}, 4e-300) == 1e-300 - 3e-300);
}
