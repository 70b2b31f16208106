// SPDX-License-Identifier: BSD-3-Clause
// What the families of scenes are built with: portable random numbers and a few ways to place
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

    /// A point of the unit circle, to within rounding.
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

/// Six digits, as in 0.3, 20000 and 1e-09: names tell small numbers apart.
std::string number(double value);

/// A scene without discs.
TestScene empty_scene(std::string name, double box_size, double radius, std::int64_t steps);

/// Appends a disc with the next id.
void add_disc(TestScene& scene, double x, double y, double vx = 0, double vy = 0);

/// Appends n still discs: at random where there is room, else on a shaken square lattice (n must be
/// a square number).
void add_gas(TestScene& scene, std::size_t n, Random& random);

/// Appends still discs of `scene.setting.effects.species`, in its order, at random where there is
/// room, which takes long in a dense box. Images count along axes that go round.
void add_species(TestScene& scene, bool round_x, bool round_y, Random& random);

/// The discs that a rank starts with: an arbitrary share, in an arbitrary order.
std::vector<InputDisc> share_of(const TestScene& scene, int rank, int n_ranks, unsigned seed);

/// Each component uniform, root mean square speed as given.
void set_speeds(TestScene& scene, double speed, Random& random);

/// A gas of n discs of radius 1, speeds in diameters per step.
TestScene gas(std::size_t n, double packing, double speed, std::uint64_t seed);

/// Each disc's neighbours in x both reach it in the first micro-step; times_kind of "rising",
/// "falling", "tied", "mixed".
TestScene chain(std::size_t n, const std::string& times_kind, std::uint64_t seed);

/// The same in a zigzag of bounded speed and length: two rows that close in, conflicts between
/// neighbours only.
TestScene zigzag(std::size_t n, const std::string& times_kind, std::uint64_t seed);

/// n discs of radius r from wall to wall with equal gaps; the first one moves with `speed`.
TestScene cradle(std::size_t n, double radius, double gap, double speed);

/// k x k discs of radius 1/2 on dyadic places.
TestScene lattice(std::size_t k, double spacing);

/// A triangle of `rows` rows of touching discs of radius r and a cue disc that aims at its tip.
TestScene break_shot(std::size_t rows, double radius, double speed, double aim);

/// The course program's generated scene with our own random numbers.
TestScene legacy_like(std::size_t n, double box_size, double radius, std::uint64_t seed);

/// Thermal walls of this seed, and to the reference what they draw: it is told, not stated a second
/// time.
void set_thermal_seed(reference::Setting& setting, std::uint64_t seed);

/// What the references are told of walls that oscillate.
void set_oscillation(reference::Setting& setting);

} // namespace carrom::test
