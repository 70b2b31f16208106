// SPDX-License-Identifier: BSD-3-Clause
// Radii that follow a distribution, compared with the C library's error function and logarithm.
#include "toml_scenes.hpp"

#include <numbers>

#include "scene/compare.hpp"
#include "scene/scene_text.hpp"
#include "scene/size_distribution.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

SizeDistribution distribution(SizeKind kind, double polydispersity) {
    SizeDistribution sizes;
    sizes.kind = kind;
    sizes.polydispersity = polydispersity;
    return sizes;
}

/// The probability of a smaller radius in a distribution without smallest and largest radius.
double probability_below(const SizeDistribution& sizes, double radius) {
    const double s = sizes.polydispersity;
    if (sizes.kind == SizeKind::uniform) return (radius - 1) / (2 * std::sqrt(3.0) * s) + 0.5;
    double z = (radius - 1) / s;
    if (sizes.kind == SizeKind::lognormal) {
        const double variance = std::log1p(s * s);
        z = (std::log(radius) + variance / 2) / std::sqrt(variance);
    }
    return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

double largest_deviation(const SizeDistribution& sizes, std::size_t n) {
    const std::vector<double> radii = radii_of_parts(sizes, n);
    const SizeLimits limits = size_limits(sizes);
    const double low = probability_below(sizes, limits.smallest),
                 high = probability_below(sizes, limits.largest);
    double worst = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const double share = (probability_below(sizes, radii[k]) - low) / (high - low),
                     wanted = (static_cast<double>(k) + 0.5) / static_cast<double>(n);
        worst = std::max(worst, std::fabs(share - wanted));
    }
    return worst;
}

} // namespace

TEST_CASE("each part of a distribution has the radius in its middle") {
    for (const SizeKind kind : {SizeKind::uniform, SizeKind::normal, SizeKind::lognormal}) {
        for (const double s : {0.01, 0.1, 0.23, 0.3}) {
            SizeDistribution sizes = distribution(kind, s);
            CAPTURE(static_cast<int>(kind));
            CAPTURE(s);
            CHECK(largest_deviation(sizes, 1000) < 1e-6);
            CHECK(largest_deviation(sizes, 7) < 1e-6);
            sizes.smallest = 0.9;
            sizes.largest = 1.4;
            CHECK(largest_deviation(sizes, 100) < 1e-6);
        }
    }
}

TEST_CASE("a range that is much wider than the distribution does not coarsen it") {
    for (const SizeKind kind : {SizeKind::normal, SizeKind::lognormal})
        for (const double s : {1e-6, 1e-3, 0.02}) {
            SizeDistribution sizes = distribution(kind, s);
            sizes.smallest = 0x1p-20;
            sizes.largest = 0x1p20;
            CAPTURE(static_cast<int>(kind));
            CAPTURE(s);
            // Radii near 1 have steps of 2^-53, which are 1e-10 of the smallest deviation.
            CHECK(largest_deviation(sizes, 7) < 1e-6);
            CHECK(largest_deviation(sizes, 1000) < 1e-6);
        }
}

TEST_CASE("any deviation gives finite radii that rise from limit to limit") {
    for (const SizeKind kind : {SizeKind::uniform, SizeKind::normal, SizeKind::lognormal})
        for (const double s : {1e-300, 1e-160, 1e-17, 1e-16, 1e-8, 1e-5, 1e-4, 2e-4, 0.3}) {
            const SizeDistribution sizes = distribution(kind, s);
            const std::vector<double> radii = radii_of_parts(sizes, 1000);
            const SizeLimits limits = size_limits(sizes);
            CAPTURE(static_cast<int>(kind));
            CAPTURE(s);
            CHECK(std::is_sorted(radii.begin(), radii.end()));
            CHECK(radii.front() >= limits.smallest * (1 - 1e-15));
            CHECK(radii.back() <= limits.largest * (1 + 1e-15));
            CHECK(share_within_limits(sizes) > 0.99);
            double sum = 0, squares = 0;
            for (const double r : radii) {
                sum += (r - 1) / 1000;
                squares += (r - 1) * (r - 1) / 1000;
            }
            if (s > 1e-10) CHECK(std::sqrt(squares - sum * sum) == Approx(s).epsilon(0.04));
        }
}

TEST_CASE("the share of a distribution between limits is that of the error function") {
    SizeDistribution sizes = distribution(SizeKind::normal, 0.01);
    sizes.smallest = 1.05; // five deviations above the mean; 1.06 is six
    sizes.largest = 1.06;
    CHECK(share_within_limits(sizes) == Approx(2.8665157e-7 - 9.8658765e-10).epsilon(1e-6));
    sizes.smallest = 0.94;
    sizes.largest = 0.95;
    CHECK(share_within_limits(sizes) == Approx(2.8665157e-7 - 9.8658765e-10).epsilon(1e-6));
    sizes.smallest = 2;
    sizes.largest = 3;
    CHECK(share_within_limits(sizes) < smallest_share);
    sizes = distribution(SizeKind::uniform, 0.1);
    sizes.largest = 1;
    CHECK(share_within_limits(sizes) == Approx(0.5));
    sizes = distribution(SizeKind::normal, 0); // all radii are 1
    CHECK(share_within_limits(sizes) == 1);
    sizes.smallest = 1.5;
    sizes.largest = 2;
    CHECK(share_within_limits(sizes) == 0);
}

TEST_CASE("mean and deviation are those that are asked for") {
    for (const SizeKind kind : {SizeKind::uniform, SizeKind::normal, SizeKind::lognormal}) {
        const SizeDistribution sizes = distribution(kind, 0.23);
        double sum = 0, squares = 0;
        const std::vector<double> radii = radii_of_parts(sizes, 1000);
        for (const double r : radii) {
            sum += r / 1000;
            squares += r * r / 1000;
        }
        CAPTURE(static_cast<int>(kind));
        // Limits at three deviations cut 2 % of the deviation of a normal distribution.
        CHECK(sum == Approx(1).epsilon(0.005));
        CHECK(std::sqrt(squares - sum * sum) == Approx(0.23).epsilon(0.04));
    }
}

TEST_CASE("discs of a distribution cover what they are to cover") {
    SizeDistribution sizes = distribution(SizeKind::lognormal, 0.3);
    const std::vector<Species> species = species_of_sizes(sizes, 12345, 700);
    std::uint64_t n = 0;
    double area = 0;
    for (const Species& one : species) {
        n += one.count;
        area += static_cast<double>(one.count) * std::numbers::pi * one.radius * one.radius;
        const double in_means = one.radius / *sizes.mean;
        CHECK(one.mass == Approx(in_means * in_means));
    }
    CHECK(n == 12345);
    CHECK(species.size() == 1000);
    CHECK(area == Approx(700).epsilon(1e-12));
    const auto by_radius = [](const Species& a, const Species& b) { return a.radius < b.radius; };
    CHECK(std::is_sorted(species.begin(), species.end(), by_radius));
    CHECK(species_of_sizes(sizes, 12, 0).size() == 12);
}

TEST_CASE("a scene with radii that follow a distribution is written and read again") {
    const std::string text = "[box]\nsize = 100\n[discs]\ncount = 300\npacking = 0.3\n"
                             "radius = {distribution = \"normal\", polydispersity = 0.2}\n"
                             "[time]\nsteps = 10\n";
    const SceneParameters scene = read_scene(text, "s.toml", {});
    CHECK(scene.packing() == Approx(0.3));
    CHECK(scene.effects.species.size() == 300);
    CHECK(scene.radius == scene.effects.species.back().radius);
    const SceneParameters again = read_scene(scene_text(scene), "again.toml", {});
    CHECK(again.effects.species == scene.effects.species);
    CHECK(scene_text(again) == scene_text(scene));
}

TEST_CASE("what is wrong with a distribution of radii is told") {
    const auto with = [](const std::string& radius) {
        const std::vector<Problem> all = problems_in(with_line(5, radius));
        std::string text;
        for (const Problem& one : all) text += one.text + '\n';
        return text;
    };
    CHECK(with("radius = {distribution = \"normal\", mean = 1, polydispersity = 0.2}") == "");
    CHECK(with("radius = {distribution = \"gauss\", mean = 1}").find("uniform") !=
          std::string::npos);
    CHECK(with("radius = {distribution = \"normal\", mean = 1, polydispersity = 0.4}")
              .find("the smallest must be positive") != std::string::npos);
    CHECK(with("radius = {distribution = \"normal\", polydispersity = 0.2}")
              .find("'discs.radius.mean' is missing") != std::string::npos);
    CHECK(with("radius = {polydispersity = 0.1}").find("'discs.radius.mean' is missing") !=
          std::string::npos);
    CHECK(with("radius = {mean = 1}\nlist = [[1, 1, 0, 0]]")
              .find("'discs.list' has no meaning where radii follow") != std::string::npos);
    CHECK(with("radius = {distribution = \"normal\", mean = 1}\npacking = 0.1")
              .find("exclude each other") != std::string::npos);
    CHECK(with("radius = {distribution = \"uniform\", mean = 1, smallest = 2, largest = 0.5}")
              .find("not above the largest") != std::string::npos);
    const std::string empty = with(
        "radius = {distribution = \"lognormal\", mean = 1, polydispersity = 0.01, "
        "smallest = 2, largest = 3}");
    CHECK(empty.find("radii from 2 to 3 times the mean hold") != std::string::npos);
    CHECK(empty.find("discs.radius.smallest") != std::string::npos);
    CHECK(with("radius = {distribution = \"normal\", mean = 1e-69, polydispersity = 0.3, "
               "smallest = 0.1}")
              .find("the radius must be from 2^-230") != std::string::npos);
}
