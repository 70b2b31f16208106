// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/legacy_discs.hpp"

#include <cmath>
#include <numbers>

#include "core/rounded_sine.hpp"
#include "initial_state/point_grid.hpp"

namespace carrom {

namespace {
// Largest number of draws for one disc. On average a disc needs some 50 draws at a packing of 0.5;
// random insertion jams at 0.54.
constexpr std::uint64_t most_draws_of_a_disc = 1'000'000;
constexpr std::uint64_t mean_draws_of_all = 500;
} // namespace

LegacyRandom::LegacyRandom(unsigned seed) { initstate_r(seed, state_, sizeof state_, &data_); }

double LegacyRandom::uniform(double low, double high) {
    std::int32_t number = 0;
    random_r(&data_, &number);
    return low + (high - low) * (number / static_cast<double>(RAND_MAX));
}

std::optional<std::vector<Point>> legacy_positions(const SceneParameters& scene,
                                                   LegacyRandom& random) {
    const double low = scene.radius, high = scene.box.x - scene.radius, diameter = 2 * scene.radius;
    PointGrid grid(0, scene.box.x, scene.box.x, diameter, static_cast<double>(scene.n_discs));
    std::vector<Point> places;
    places.reserve(scene.n_discs);
    std::uint64_t draws_left = most_draws_of_a_disc + mean_draws_of_all * scene.n_discs;
    while (places.size() < scene.n_discs) {
        Point place;
        bool is_free = false;
        for (std::uint64_t draw = 0; !is_free && draw < most_draws_of_a_disc && draws_left > 0;
             ++draw, --draws_left) {
            place.x = random.uniform(low, high);
            place.y = random.uniform(low, high);
            is_free = !grid.any_near(place, [&](std::uint32_t k) {
                const double dx = place.x - places[k].x, dy = place.y - places[k].y;
                return diameter > std::sqrt(dx * dx + dy * dy);
            });
        }
        if (!is_free) return std::nullopt;
        grid.add(place);
        places.push_back(place);
    }
    return places;
}

InputDisc legacy_disc(const SceneParameters& scene, LegacyRandom& random, DiscId id, Point place) {
    const double speed = random.uniform(scene.box.x / (8 * scene.radius), scene.box.x / 4);
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const RoundedSine direction = rounded_sine(angle);
    return {id, place.x, place.y, speed * direction.cosine, speed * direction.sine};
}

} // namespace carrom
