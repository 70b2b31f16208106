// SPDX-License-Identifier: BSD-3-Clause
// Dense starts by compression, compared with the distances of all pairs and with the discs that one
// rank makes alone.
#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "core/state_hash.hpp"
#include "initial_state/velocities.hpp"
#include "parallel/exchange.hpp"
#include "scene/read_scene.hpp"
#include "simulation/disc_system.hpp"
#include "simulation/first_discs.hpp"

using namespace carrom;

namespace {

SceneParameters compressed_scene(const std::vector<std::string>& overrides) {
    return read_scene(
        "[box]\nsize = 50\n[discs]\ngenerator = 'compressed'\nspeed = 0.25\nseed = 5\n"
        "[time]\nsteps = 20\n",
        "s.toml", overrides);
}

const std::string all_round = "box.left.kind=periodic box.right.kind=periodic "
                              "box.bottom.kind=periodic box.top.kind=periodic";

SceneParameters compressed_scene(const std::string& overrides) {
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin < overrides.size();) {
        const std::size_t end = std::min(overrides.find(' ', begin), overrides.size());
        words.push_back(overrides.substr(begin, end - begin));
        begin = end + 1;
    }
    return compressed_scene(words);
}

Tuning with_threads(int n) {
    Tuning tuning;
    tuning.threads = n;
    tuning.discs_per_thread = 1;
    return tuning;
}

std::vector<InputDisc> on_root(const std::vector<InputDisc>& mine, const Communicator& world) {
    std::vector<std::vector<InputDisc>> out(static_cast<std::size_t>(world.size()));
    out[0] = mine;
    std::vector<InputDisc> all = send_to_owners(world, out).items;
    std::sort(all.begin(), all.end(),
              [](const InputDisc& a, const InputDisc& b) { return a.id < b.id; });
    return all;
}

/// The smallest gap between any two discs, and between any disc and a wall.
double least_gap(const std::vector<InputDisc>& discs, const SceneParameters& scene) {
    const double length = scene.box.x;
    const bool goes_round_x = scene.effects.is_periodic_x(),
               goes_round_y = scene.effects.is_periodic_y();
    const auto radius_of = [&](DiscId id) {
        for (const Species& one : scene.effects.species) {
            if (id < one.count) return one.radius;
            id -= one.count;
        }
        return scene.radius;
    };
    const auto apart = [length](double a, double b, bool goes_round) {
        const double d = std::fabs(a - b);
        return goes_round ? std::min(d, length - d) : d;
    };
    double least = length;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const InputDisc& p = discs[i];
        const double r = radius_of(p.id);
        if (!goes_round_x) least = std::min({least, p.x - r, length - p.x - r});
        if (!goes_round_y) least = std::min({least, p.y - r, length - p.y - r});
        for (std::size_t j = 0; j < i; ++j)
            least = std::min(least, std::hypot(apart(p.x, discs[j].x, goes_round_x),
                                               apart(p.y, discs[j].y, goes_round_y)) -
                                        r - radius_of(discs[j].id));
    }
    return least;
}

} // namespace

TEST_CASE("compressed discs do not overlap, and are the same on any ranks and threads") {
    const Communicator world = Communicator::world();
    const std::string mixture = "discs.species=[{count=55,radius=1.5},{count=90,radius=1.07}] "
                                "box.size=30 ";
    for (const std::string& overrides :
         {"discs.count=150 discs.packing=0.8 " + all_round,
          std::string("discs.count=120 discs.packing=0.76 discs.growth_rate=0.05"),
          mixture + all_round, mixture + "box.left.kind=periodic box.right.kind=periodic",
          std::string("discs.count=200 discs.packing=0.2")}) {
        INFO(overrides);
        const SceneParameters scene = compressed_scene(overrides);
        // With several ranks, threads would wait for each other.
        const int n_threads = world.size() == 1 && scene.n_discs == 150 ? 2 : 1;
        const std::vector<InputDisc> all = on_root(
            first_discs(scene, nullptr, world, with_threads(n_threads)), world);
        if (!world.is_root()) continue;
        const std::vector<InputDisc> alone = on_root(
            first_discs(scene, nullptr, Communicator::of_this_rank(), with_threads(1)),
            Communicator::of_this_rank());
        CHECK(all == alone);
        REQUIRE(all.size() == scene.n_discs);
        // Between walls the drift is not subtracted, so velocities are the drawn ones times a
        // factor.
        const bool has_walls = !scene.effects.is_periodic_x() && !scene.effects.is_periodic_y();
        const double scale = all[0].vx / drawn_velocity(scene, 0).x;
        bool are_right = true;
        double square = 0;
        for (DiscId id = 0; id < all.size(); ++id) {
            const Velocity v = drawn_velocity(scene, id);
            const double off = std::hypot(all[id].vx - scale * v.x, all[id].vy - scale * v.y);
            are_right = are_right && all[id].id == id && (!has_walls || off < 1e-15);
            square += all[id].vx * all[id].vx + all[id].vy * all[id].vy;
        }
        CHECK(are_right);
        CHECK(square == Approx(0.25 * 0.25 * static_cast<double>(all.size())).epsilon(1e-13));
        const double gap = least_gap(all, scene);
        CHECK(gap > 0);
        // gaps are as small as required
        if (scene.packing() > 0.5) CHECK(gap < 1e-3 * scene.radius);
    }
}

TEST_CASE("compression goes on to more than eight tenths, and a run begins there") {
    const Communicator world = Communicator::world();
    const SceneParameters scene = compressed_scene("discs.count=100 discs.packing=0.82 " +
                                                   all_round);
    std::vector<InputDisc> discs = first_discs(scene, nullptr, world, with_threads(1));
    CHECK(least_gap(on_root(discs, world), scene) > 0);
    DiscSystem system(scene, std::move(discs), world, with_threads(1));
    CHECK(system.totals().overlapping_pairs == 0);
    while (system.step() < scene.steps) system.advance_towards(scene.steps);
    CHECK(system.totals().overlapping_pairs == 0);
    CHECK(system.totals().pair_collisions > 500);
}

TEST_CASE("compression that jams ends with the packing fraction that it has reached") {
    const Communicator world = Communicator::world();
    const SceneParameters scene = compressed_scene(
        "discs.count=100 discs.packing=0.9 discs.growth_rate=0.1");
    std::string text;
    try {
        first_discs(scene, nullptr, world, with_threads(1));
    } catch (const InputError& error) {
        text = error.what();
    }
    INFO(text);
    CHECK(text.find("the compression jams at a packing fraction of 0.") != std::string::npos);
    CHECK(text.find("0.9 is wanted") != std::string::npos);
}
