// SPDX-License-Identifier: BSD-3-Clause
// Velocities of generated discs compared with their distributions.
#include "catch.hpp"

#include <cmath>
#include <vector>

#include "core/state_hash.hpp"
#include "initial_state/velocities.hpp"
#include "statistics.hpp"

using namespace carrom;
using test::kolmogorov_smirnov;
using test::mean;

namespace {

constexpr std::uint64_t n_discs = 200000;

struct Sample {
    std::vector<double> vx, vy, speed, square, product;
};

Sample sample_of(VelocityKind kind) {
    SceneParameters scene;
    scene.velocities = kind;
    Sample sample;
    for (DiscId id = 0; id < n_discs; ++id) {
        const Velocity v = drawn_velocity(scene, id);
        sample.vx.push_back(v.x);
        sample.vy.push_back(v.y);
        sample.speed.push_back(std::hypot(v.x, v.y));
        sample.square.push_back(v.x * v.x + v.y * v.y);
        sample.product.push_back(v.x * v.y);
    }
    return sample;
}

const double root_n = std::sqrt(static_cast<double>(n_discs));

} // namespace

TEST_CASE("Maxwell velocities: speeds, components and moments") {
    const double rms = 1;
    const Sample sample = sample_of(VelocityKind::maxwell);
    CHECK(kolmogorov_smirnov(
              sample.speed, [rms](double v) { return 1 - std::exp(-v * v / (rms * rms)); }) < 1.95);
    const auto normal = [rms](double v) {
        return 0.5 * (1 + std::erf(v / rms));
    }; // cumulative distribution for the standard deviation rms / sqrt(2)
    CHECK(kolmogorov_smirnov(sample.vx, normal) < 1.95);
    CHECK(kolmogorov_smirnov(sample.vy, normal) < 1.95);
    CHECK(std::fabs(mean(sample.vx)) < 4 * rms / std::sqrt(2) / root_n);
    CHECK(std::fabs(mean(sample.vy)) < 4 * rms / std::sqrt(2) / root_n);
    CHECK(std::fabs(mean(sample.square) - rms * rms) < 4 * rms * rms / root_n);
    CHECK(std::fabs(mean(sample.product)) < 4 * rms * rms / 2 / root_n);
}

TEST_CASE("uniform velocities: speeds up to sqrt(3) times their root mean square") {
    const double rms = 1;
    const double largest = std::sqrt(3.0) * rms;
    const Sample sample = sample_of(VelocityKind::uniform);
    CHECK(kolmogorov_smirnov(sample.speed, [largest](double v) { return v / largest; }) < 1.95);
    CHECK(std::fabs(mean(sample.square) - rms * rms) < 4 * rms * rms * std::sqrt(0.8) / root_n);
    CHECK(std::fabs(mean(sample.vx)) < 4 * rms / std::sqrt(2) / root_n);
    CHECK(*std::max_element(sample.speed.begin(), sample.speed.end()) <= largest * (1 + 1e-15));
}

TEST_CASE("the default seed's velocities stay what they are") {
    // A seed must always give the same discs: these are the bits of the first release.
    for (const auto& [kind, bits] :
         {std::pair{VelocityKind::maxwell, "c74526b503958107f3be3495a260f322"},
          std::pair{VelocityKind::uniform, "8688534e85de909de50fcf9ee869d5f5"}}) {
        SceneParameters scene;
        scene.velocities = kind;
        StateHash hash;
        for (DiscId id = 0; id < 1000; ++id) {
            const Velocity v = drawn_velocity(scene, id);
            hash += hash_of(DiscState{0, 0, v.x, v.y, 0, id});
        }
        CHECK(to_string(hash) == bits);
    }
}

TEST_CASE("streams add up where they overlap") {
    SceneParameters scene;
    scene.streams = {{0, 0, 2, 2, 1, 0}, {1, 1, 3, 3, 0.5, -1}};
    CHECK(stream_velocity(scene, {0.5, 0.5}) == Velocity{1, 0});
    CHECK(stream_velocity(scene, {1.5, 1.5}) == Velocity{1.5, -1});
    CHECK(stream_velocity(scene, {3, 3}) == Velocity{0.5, -1});
    CHECK(stream_velocity(scene, {3, 3.5}) == Velocity{0, 0});
}
