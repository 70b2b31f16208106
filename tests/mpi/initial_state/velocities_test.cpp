// SPDX-License-Identifier: BSD-3-Clause
// Velocities of generated discs: their energy and momentum, and the same bits on any ranks.
#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/state_hash.hpp"
#include "initial_state/initial_state.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;

namespace {

using Texts = std::vector<std::string>;

const std::string species = "discs.species=[{count=300, radius=0.1, mass=4}, "
                            "{count=500, radius=0.05, mass=0.25}, {count=1, radius=1, mass=900}]";
const std::string round_x = "box.left.kind=periodic", round_x2 = "box.right.kind=periodic",
                  round_y = "box.bottom.kind=periodic", round_y2 = "box.top.kind=periodic";

SceneParameters scene_of(const Texts& overrides) {
    return read_scene("[box]\nsize = 20\n[discs]\nseed = 8\n[time]\nsteps = 1\n", "s.toml",
                      overrides);
}

struct Sums {
    double momentum_x = 0, momentum_y = 0, energy = 0, mass = 0;
    std::vector<double> energies; ///< energy of each species
    StateHash hash;
};

/// Plain sums over the discs of a single rank.
Sums sums_of(const SceneParameters& scene, const std::vector<InputDisc>& discs) {
    Sums sums;
    sums.energies.resize(std::max<std::size_t>(1, scene.effects.species.size()));
    for (const InputDisc& disc : discs) {
        std::size_t k = 0;
        DiscId end = 0;
        for (const Species& one : scene.effects.species) {
            end += one.count;
            if (disc.id < end) break;
            ++k;
        }
        const double mass = scene.effects.species.empty() ? 1 : scene.effects.species[k].mass,
                     energy = mass * (disc.vx * disc.vx + disc.vy * disc.vy) / 2;
        sums.momentum_x += mass * disc.vx;
        sums.momentum_y += mass * disc.vy;
        sums.energy += energy;
        sums.energies[k] += energy;
        sums.mass += mass;
        sums.hash += hash_of(DiscState{disc.x, disc.y, disc.vx, disc.vy, 0, disc.id});
    }
    return sums;
}

Sums sums_of(const SceneParameters& scene) {
    return sums_of(scene, initial_state(scene, nullptr, Communicator::of_this_rank()));
}

} // namespace

TEST_CASE("generated discs have the energy that is asked for, and no drift along periodic axes") {
    const Texts plain = {"discs.count=500", "discs.radius=0.1"}, mixed = {species};
    for (const Texts& discs : {plain, mixed}) {
        for (const char* motion : {"discs.speed=0.3", "discs.temperature=0.045"}) {
            for (const char* kind : {"maxwell", "uniform"}) {
                Texts walls = discs;
                walls.insert(walls.end(), {motion, fmt::format("discs.velocities={}", kind)});
                Texts channel = walls, round = walls;
                channel.insert(channel.end(), {round_x, round_x2});
                round.insert(round.end(), {round_x, round_x2, round_y, round_y2});
                CAPTURE(walls);
                const double n = discs == plain ? 500 : 801;
                for (const Texts& all : {walls, channel, round}) {
                    const SceneParameters scene = scene_of(all);
                    const Sums sums = sums_of(scene);
                    const double wanted = scene.temperature ? n * 0.045 : sums.mass * 0.045;
                    CHECK(sums.energy == Approx(wanted).epsilon(1e-13));
                    const double scale = std::sqrt(2 * sums.energy * sums.mass),
                                 x = std::fabs(sums.momentum_x) / scale,
                                 y = std::fabs(sums.momentum_y) / scale;
                    // A random sample has a momentum of about scale / sqrt(n).
                    if (all == walls) CHECK(x > 1e-4);
                    if (all != walls) CHECK(x < 1e-15);
                    if (all != round) CHECK(y > 1e-4);
                    if (all == round) CHECK(y < 1e-15);
                }
            }
        }
    }
}

TEST_CASE("a temperature is that of every species, but for chance") {
    const Sums sums = sums_of(scene_of({species, "discs.temperature=2"}));
    // The energy of n discs has a relative error of 1 / sqrt(n).
    CHECK(sums.energies[0] / 300 == Approx(2).epsilon(4 / std::sqrt(300.0)));
    CHECK(sums.energies[1] / 500 == Approx(2).epsilon(4 / std::sqrt(500.0)));
}

TEST_CASE("velocities have the same bits on any number of ranks") {
    const Communicator world = Communicator::world();
    for (const char* motion : {"discs.speed=0.3", "discs.temperature=7e-5"}) {
        const SceneParameters scene = scene_of(
            {species, motion, round_x, round_x2, round_y, round_y2});
        const StateHash mine = sums_of(scene, initial_state(scene, nullptr, world)).hash;
        const StateHash all{world.sum(mine.low), world.sum(mine.high)};
        CHECK(all == sums_of(scene).hash);
    }
}

TEST_CASE("a disc that is alone in a periodic box moves, and no speed is no motion") {
    const Texts round = {round_x, round_x2, round_y, round_y2};
    Texts one = round, still = round;
    one.insert(one.end(), {"discs.count=1", "discs.radius=1", "discs.speed=0.5"});
    still.insert(still.end(), {"discs.count=10", "discs.radius=1", "discs.temperature=0"});
    CHECK(sums_of(scene_of(one)).energy == Approx(0.125));
    CHECK(sums_of(scene_of(still)).energy == 0);
}
