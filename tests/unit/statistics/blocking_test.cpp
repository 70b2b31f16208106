// SPDX-License-Identifier: BSD-3-Clause
// Reported errors compared with the scatter between many series whose correlation is known: x' = a
// x + noise has the variance 1 and the correlation time 1 / log(1 / a).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "catch.hpp"
#include "statistics/blocking.hpp"

using namespace carrom;

namespace {

std::vector<double> series(std::size_t n, double correlation_time, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    // Sums of twelve numbers are nearly Gaussian, and have the same bits with every library.
    const auto gaussian = [&random] {
        double sum = -6;
        for (int k = 0; k < 12; ++k) sum += std::ldexp(static_cast<double>(random() >> 11), -53);
        return sum;
    };
    const double kept = correlation_time > 0 ? std::exp(-1 / correlation_time) : 0;
    std::vector<double> x = {gaussian()};
    while (x.size() < n) x.push_back(kept * x.back() + std::sqrt(1 - kept * kept) * gaussian());
    return x;
}

SampledMean mean_of(const std::vector<double>& x) {
    VectorBlocks blocks(1);
    for (const double one : x) blocks.add(std::vector{one});
    return blocks.means()[0];
}

struct Claims {
    double scatter_over_claim = 0, correlation_time = 0, share_changing = 0;
};

Claims claims_of(std::size_t n, double correlation_time, int n_runs) {
    double squares = 0, claimed = 0, times = 0, changing = 0;
    for (int run = 0; run < n_runs; ++run) {
        const SampledMean mean = mean_of(
            series(n, correlation_time, 1000 + static_cast<std::uint64_t>(run)));
        squares += mean.value * mean.value; // the true mean is 0
        claimed += mean.error * mean.error;
        times += mean.correlation_time / n_runs;
        changing += mean.is_changing;
    }
    return {std::sqrt(squares / claimed), times, changing / n_runs};
}

} // namespace

TEST_CASE("the claimed error is the scatter between runs, with and without correlation") {
    for (const double share : {0.0, 1.0 / 256, 1.0 / 64, 1.0 / 32}) {
        const Claims claims = claims_of(3000, 3000 * share, 400);
        CAPTURE(share, claims.scatter_over_claim, claims.share_changing);
        CHECK(claims.scatter_over_claim > 0.85);
        CHECK(claims.scatter_over_claim < 1.15);
        CHECK(claims.share_changing < 0.02);
    }
}

TEST_CASE("the correlation time is that of the series where blocks are shorter") {
    const Claims claims = claims_of(3000, 60, 400); // blocks have 32 samples
    CAPTURE(claims.correlation_time);
    CHECK(claims.correlation_time > 50);
    CHECK(claims.correlation_time < 85);
    CHECK(claims_of(3000, 0, 100).correlation_time < 20);
}

TEST_CASE("a trend is reported, a constant is known to be one") {
    const auto changes = [](auto value) {
        std::vector<double> x = series(1000, 0, 7);
        for (std::size_t k = 0; k < x.size(); ++k)
            x[k] = value(static_cast<double>(k) / 1000, 0.01 * x[k]);
        return mean_of(x);
    };
    CHECK(changes([](double t, double noise) { return t + noise; }).is_changing);
    CHECK(changes([](double t, double) { return 1 / ((1 + 20 * t) * (1 + 20 * t)); }).is_changing);
    CHECK(changes([](double t, double noise) { return 29 - 0.03 * t + noise; }).is_changing);
    CHECK_FALSE(changes([](double, double noise) { return 29 + noise; }).is_changing);
    const SampledMean constant = changes([](double, double noise) { return 3 + 1e-12 * noise; });
    CHECK(constant.is_constant);
    CHECK_FALSE(constant.is_changing);
}

TEST_CASE("a rare event is no trend, early or late in a series") {
    for (const std::size_t at : {0u, 3u, 20u, 60u, 63u}) {
        std::vector<double> x(64);
        x[at] = 1;
        CAPTURE(at);
        CHECK_FALSE(mean_of(x).is_changing);
    }
}

TEST_CASE("short series have no error, and memory does not grow") {
    CHECK(std::isnan(mean_of({1, 2, 4}).error));
    CHECK(mean_of({1, 2, 4}).value == Approx(7.0 / 3));
    CHECK(mean_of({1, 2, 4, 3}).error > 0);
    VectorBlocks blocks(3);
    for (int k = 0; k < 100000; ++k) blocks.add(std::vector<double>{1.0 * k, 1, 0});
    CHECK(blocks.n_samples() == 100000);
    CHECK(blocks.words().size() <= 3 * (most_blocks + 1) + 3);
    CHECK(blocks.means()[0].value == Approx(49999.5));
    CHECK(blocks.means()[2].error == 0);
}

TEST_CASE("equal halves do not make the error 0") {
    CHECK(mean_of({1, 3, 2, 2}).error == Approx(std::sqrt(0.5 / 3)));
    CHECK(mean_of({1, 0, 0, 0, 0, 0, 0, 1}).error > 0.1);
}

TEST_CASE("the error of a sum allows for values that vary together") {
    const std::vector<double> noise = series(20000, 1, 7);
    VectorBlocks blocks(2);
    double mean = 0, square = 0;
    for (const double x : noise) {
        mean += (1000 + x) / static_cast<double>(noise.size());
        square += x * x / static_cast<double>(noise.size());
        blocks.add(std::vector{(1000 + x) * (1000 + x), 1000 + x});
    }
    // The correlation of squares relative to the mean decays twice as fast. So the error of their
    // mean is the variance times sqrt(2 (1 + a^2) / (1 - a^2) / n) with a = 1 / e. The mean of
    // squares alone has an error that is some 2000 times the root of the variance over n.
    const SampledMean variance = blocks.weighted_mean(std::array{1.0, -2 * mean});
    CHECK(variance.value + mean * mean == Approx(square).epsilon(0.01));
    const double squared_a = std::exp(-2),
                 in_sum = 2 * (1 + squared_a) / (1 - squared_a) / static_cast<double>(noise.size());
    CHECK(variance.error == Approx(square * std::sqrt(in_sum)).epsilon(0.25));
    CHECK(blocks.means()[0].error > 100 * variance.error);
}

TEST_CASE("blocks that go on from a checkpoint's words have the same bits") {
    const std::vector<double> x = series(777, 5, 3);
    VectorBlocks whole(2), first(2);
    for (std::size_t k = 0; k < x.size(); ++k) {
        whole.add(std::vector{x[k], -x[k]});
        if (k < 333) first.add(std::vector{x[k], -x[k]});
    }
    VectorBlocks other(3), rest(2);
    CHECK_FALSE(other.set_words(first.words()));
    REQUIRE(rest.set_words(first.words()));
    for (std::size_t k = 333; k < x.size(); ++k) rest.add(std::vector{x[k], -x[k]});
    CHECK(rest.words() == whole.words());
    CHECK_FALSE(rest.set_words(std::vector<std::int64_t>{2, 1}));
}
