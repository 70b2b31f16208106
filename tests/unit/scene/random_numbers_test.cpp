// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <cmath>
#include <set>
#include <vector>

#include "core/random_numbers.hpp"
#include "statistics.hpp"

using namespace carrom;
using test::kolmogorov_smirnov;
using test::mean;

namespace {
constexpr std::uint64_t n_samples = 200000;
}

TEST_CASE("Philox gives the words its authors publish") {
    // Known answers of philox4x64-10 from the Random123 distribution.
    CHECK(random_words(0, static_cast<Purpose>(0), 0, 0) ==
          std::array<std::uint64_t, 4>{0x16554d9eca36314c, 0xdb20fe9d672d0fdc, 0xd7e772cee186176b,
                                       0x7e68b68aec7ba23b});
}

TEST_CASE("another seed, purpose, disc, attempt or block gives other words") {
    std::set<std::array<std::uint64_t, 4>> all;
    for (const std::uint64_t seed : {1u, 2u})
        for (const Purpose purpose : {Purpose::position, Purpose::shake, Purpose::velocity})
            for (const DiscId id : {0u, 1u, 2u})
                for (const std::uint64_t attempt : {0u, 1u})
                    for (const std::uint64_t block : {0u, 1u})
                        all.insert(random_words(seed, purpose, id, attempt, block));
    CHECK(all.size() == 2 * 3 * 3 * 2 * 2);
}

TEST_CASE("unit numbers are uniform from 0 to below 1") {
    CHECK(unit_number(0) == 0);
    CHECK(unit_number(~std::uint64_t{0}) == 1 - 0x1p-53);
    std::vector<double> sample;
    DiscRandom random(3, Purpose::velocity, 17);
    for (std::uint64_t i = 0; i < n_samples; ++i) sample.push_back(random.uniform());
    CHECK(kolmogorov_smirnov(sample, [](double x) { return x; }) < 1.95);
    double product = 0;
    for (std::size_t i = 1; i < sample.size(); ++i)
        product += (sample[i] - 0.5) * (sample[i - 1] - 0.5);
    CHECK(std::fabs(product / static_cast<double>(n_samples)) <
          4 * (1.0 / 12) / std::sqrt(n_samples));
}

TEST_CASE("the first exponential numbers of many discs have the exponential distribution") {
    std::vector<double> sample;
    for (DiscId id = 0; id < n_samples; ++id) {
        DiscRandom random(5, Purpose::velocity, id);
        sample.push_back(random_exponential(random));
    }
    CHECK(kolmogorov_smirnov(sample, [](double x) { return 1 - std::exp(-x); }) < 1.95);
    CHECK(std::fabs(mean(sample) - 1) < 4 / std::sqrt(n_samples)); // standard deviation 1
    double fourth = 0;
    for (const double x : sample) fourth += x * x * x * x;
    CHECK(fourth / static_cast<double>(n_samples) ==
          Approx(24).epsilon(4 * std::sqrt(40320 - 576) / 24 / std::sqrt(n_samples)));
}

TEST_CASE("directions have length 1 and no preference") {
    std::vector<double> angles;
    double longest = 0, shortest = 2;
    for (DiscId id = 0; id < n_samples; ++id) {
        DiscRandom random(7, Purpose::velocity, id);
        const Direction d = random_direction(random);
        angles.push_back(std::atan2(d.y, d.x));
        longest = std::max(longest, std::hypot(d.x, d.y));
        shortest = std::min(shortest, std::hypot(d.x, d.y));
    }
    const double pi = std::acos(-1.0);
    CHECK(kolmogorov_smirnov(angles, [pi](double a) { return (a + pi) / (2 * pi); }) < 1.95);
    CHECK(longest <= 1 + 1e-15);
    CHECK(shortest >= 1 - 1e-15);
}
