// SPDX-License-Identifier: BSD-3-Clause
// Tools with which families of scenes are built: portable random numbers and a few ways to place
// discs.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "scenes.hpp"

namespace carrom::test {

/// Uniform numbers whose bits do not depend on the standard library.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    std::size_t index(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

    /// A random point of the unit circle, to within rounding.
    std::pair<double, double> direction() {
        for (;;) {
            const double x = uniform(-1, 1), y = uniform(-1, 1);
            const double square = x * x + y * y;
            if (square > 0.01 && square <= 1) return {x / std::sqrt(square), y / std::sqrt(square)};
        }
    }

    template <class Item> void shuffle(std::vector<Item>& items) {
        for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[index(i)]);
    }

private:
    std::mt19937_64 engine_;
};

/// The number with up to six digits, such as 0.3 and 1e-09, so that names tell small ones apart.
std::string number(double value);

/// A scene without discs.
TestScene empty_scene(std::string name, double box_size, double radius, std::int64_t steps);

/// Appends a disc with the next id.
void add_disc(TestScene& scene, double x, double y, double vx = 0, double vy = 0);

/// Appends n discs at rest, at random if there is room, else on a shaken square lattice (n must be
/// a square number).
void add_gas(TestScene& scene, std::size_t n, Random& random);

/// Appends discs at rest of `scene.setting.effects.species`, in its order, at random without
/// overlaps, also of images along the axes that are round. Takes long in a dense box.
void add_species(TestScene& scene, bool round_x, bool round_y, Random& random);

/// The random share of the discs with which a rank starts, in a random order.
std::vector<InputDisc> share_of(const TestScene& scene, int rank, int n_ranks, unsigned seed);

/// Sets velocities with uniform components and this root mean square speed.
void set_speeds(TestScene& scene, double speed, Random& random);

/// A gas of n discs of radius 1; `speed` is in diameters per step.
TestScene gas(std::size_t n, double packing, double speed, std::uint64_t seed);

/// Discs whose two neighbours in x both reach them in the first micro-step; `times_kind` is
/// "rising", "falling", "tied" or "mixed".
TestScene chain(std::size_t n, const std::string& times_kind, std::uint64_t seed);

/// A chain in a zigzag, of bounded speed and length: two rows that approach, so that only
/// neighbours are in conflict.
TestScene zigzag(std::size_t n, const std::string& times_kind, std::uint64_t seed);

/// n discs of radius r from wall to wall with equal gaps; the first one moves with `speed`.
TestScene cradle(std::size_t n, double radius, double gap, double speed);

/// k x k discs of radius 1/2 on dyadic places.
TestScene lattice(std::size_t k, double spacing);

/// A triangle of `rows` rows of touching discs of radius r, and a disc that flies towards its tip.
TestScene break_shot(std::size_t rows, double radius, double speed, double aim);

/// A scene like those of the course program's generator, with portable random numbers.
TestScene legacy_like(std::size_t n, double box_size, double radius, std::uint64_t seed);

/// Sets the seed of thermal walls, and gives the reference their random numbers.
void set_thermal_seed(reference::Setting& setting, std::uint64_t seed);

/// Gives the references the functions of oscillating walls.
void set_oscillation(reference::Setting& setting);

} // namespace carrom::test
