// SPDX-License-Identifier: BSD-3-Clause
// The first discs, compared with references without ranks, grids or chunks. Every number of ranks
// must give the same discs.
#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "core/random_numbers.hpp"
#include "core/state_hash.hpp"
#include "gathered.hpp"
#include "initial_state/initial_state.hpp"
#include "initial_state/velocities.hpp"
#include "insertion_rule.hpp"
#include "lattices/lattice.hpp"
#include "parallel/communicator.hpp"
#include "quad.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;

namespace {

using Texts = std::vector<std::string>;
using Discs = std::vector<InputDisc>;

const Communicator& ranks() {
    static const Communicator world = Communicator::world();
    return world;
}

SceneParameters scene_of(const Texts& overrides) {
    return read_scene(
        "[box]\nsize = 10\n[discs]\ncount = 100\nradius = 0.1\nspeed = 0.25\n[time]\nsteps = 1\n",
        "s.toml", overrides);
}

StateHash hash_of_discs(const Discs& discs) {
    StateHash hash;
    for (const InputDisc& d : discs) hash += hash_of(DiscState{d.x, d.y, d.vx, d.vy, 0, d.id});
    return hash;
}

/// The hash of all ranks' discs.
StateHash hash_of_all(const Discs& mine) {
    const StateHash hash = hash_of_discs(mine);
    return {ranks().sum(hash.low), ranks().sum(hash.high)};
}

void check_same(const Discs& mine, const Discs& reference) {
    CHECK(ranks().sum(std::uint64_t{mine.size()}) == reference.size());
    CHECK(hash_of_all(mine) == hash_of_discs(reference));
}

/// All discs on every rank, by id.
Discs all_by_id(const Discs& mine) {
    Discs all = gathered(mine, ranks());
    std::sort(all.begin(), all.end(),
              [](const InputDisc& a, const InputDisc& b) { return a.id < b.id; });
    return all;
}

/// The expected velocities, with long sums in the order of ids: drawn velocities without the drift
/// along periodic axes, scaled to the energy of the scene.
void give_velocities_by_hand(const SceneParameters& scene, Discs& discs) {
    const auto mass_of = [&](DiscId id) -> long double {
        for (const Species& one : scene.effects.species) {
            if (id < one.count) return one.mass;
            id -= one.count;
        }
        return 1;
    };
    long double mass = 0, px = 0, py = 0, energy = 0;
    std::vector<std::array<long double, 2>> v;
    for (const InputDisc& disc : discs) {
        const long double m = mass_of(disc.id), root = scene.temperature ? std::sqrt(m) : 1;
        const Velocity drawn = drawn_velocity(scene, disc.id);
        v.push_back({drawn.x / root, drawn.y / root});
        mass += m;
        px += m * v.back()[0];
        py += m * v.back()[1];
    }
    for (std::size_t i = 0; i < discs.size(); ++i) {
        if (scene.effects.is_periodic_x() && discs.size() > 1) v[i][0] -= px / mass;
        if (scene.effects.is_periodic_y() && discs.size() > 1) v[i][1] -= py / mass;
        energy += mass_of(discs[i].id) * (v[i][0] * v[i][0] + v[i][1] * v[i][1]) / 2;
    }
    const long double wanted = scene.temperature
                                   ? static_cast<long double>(discs.size()) * *scene.temperature
                                   : mass * scene.speed * scene.speed / 2;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        discs[i].vx = static_cast<double>(v[i][0] * std::sqrt(wanted / energy));
        discs[i].vy = static_cast<double>(v[i][1] * std::sqrt(wanted / energy));
    }
}

/// Positions must be equal, and velocities equal up to rounding.
void check_generated(const Discs& mine, const Discs& reference) {
    const Discs all = all_by_id(mine);
    if (!ranks().is_root()) return;
    REQUIRE(all.size() == reference.size());
    bool are_placed = true;
    double farthest = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const InputDisc &a = all[i], &b = reference[i];
        are_placed = are_placed && a.id == b.id && a.x == b.x && a.y == b.y;
        farthest = std::max({farthest, std::fabs(a.vx - b.vx), std::fabs(a.vy - b.vy)});
    }
    CHECK(are_placed);
    CHECK(farthest < 1e-15);
}

/// Rank 0 checks that all discs are there, lie in the box and do not overlap.
void check_arrangement(const Discs& mine, const SceneParameters& scene) {
    Discs all = all_by_id(mine);
    if (!ranks().is_root()) return;
    CHECK(all.size() == scene.n_discs);
    bool ids_are_right = true, all_are_inside = true;
    for (std::size_t i = 0; i < all.size(); ++i) {
        ids_are_right = ids_are_right && all[i].id == i;
        for (const double c : {all[i].x, all[i].y})
            all_are_inside = all_are_inside && c >= scene.radius && c <= scene.box.x - scene.radius;
    }
    CHECK(ids_are_right);
    CHECK(all_are_inside);
    std::sort(all.begin(), all.end(),
              [](const InputDisc& a, const InputDisc& b) { return a.x < b.x; });
    double nearest = scene.box.x;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = i + 1; j < all.size() && all[j].x - all[i].x < nearest; ++j)
            nearest = std::min(nearest, std::hypot(all[j].x - all[i].x, all[j].y - all[i].y));
    CHECK(nearest >= 2 * scene.radius * (1 - 1e-15));
}

Discs inserted_by_the_rule(const SceneParameters& scene) {
    const std::vector<Point> places = places_by_the_rule(scene, 0);
    Discs discs;
    for (DiscId id = 0; id < scene.n_discs; ++id)
        discs.push_back({id, places[id].x, places[id].y, 0, 0});
    give_velocities_by_hand(scene, discs);
    return discs;
}

/// The legacy generator as written in C: plain `rand`, and a comparison with all earlier discs.
/// Sines and cosines are rounded correctly, because C libraries round differently on processors.
Discs legacy_by_hand(std::uint64_t n, double box, double r) {
    std::srand(3210);
    const auto uniform = [](double low, double high) {
        return low + (high - low) * (std::rand() / static_cast<double>(RAND_MAX));
    };
    Discs discs;
    while (discs.size() < n) {
        InputDisc disc{discs.size(), 0, 0, 0, 0};
        for (bool is_free = false; !is_free;) {
            disc.x = uniform(r, box - r);
            disc.y = uniform(r, box - r);
            is_free = true;
            for (const InputDisc& other : discs)
                if (std::sqrt((disc.x - other.x) * (disc.x - other.x) +
                              (disc.y - other.y) * (disc.y - other.y)) < 2 * r)
                    is_free = false;
        }
        discs.push_back(disc);
    }
    for (InputDisc& disc : discs) {
        const double speed = uniform(box / (8 * r), box / 4);
        const double angle = uniform(0, 2 * std::acos(-1.0));
        disc.vx = speed * test::nearest_cosine(angle);
        disc.vy = speed * test::nearest_sine(angle);
    }
    return discs;
}

struct Listing {
    SceneParameters scene;
    std::unique_ptr<std::istringstream> stream;
};

/// A list as the program opens it: rank 0 has the stream, all ranks have the scene.
Listing listing_of(const std::string& text) {
    auto stream = std::make_unique<std::istringstream>(text);
    const SceneText input = read_scene_text(*stream, "t.in");
    SceneParameters scene = read_scene(input);
    if (!ranks().is_root()) stream.reset();
    return {std::move(scene), std::move(stream)};
}

} // namespace

TEST_CASE("random insertion follows its rule on any number of ranks") {
    for (const Texts& overrides :
         {Texts{"discs.packing=0.3"}, Texts{"discs.packing=0.45", "discs.seed=9"},
          Texts{"discs.packing=0.01"}, Texts{"discs.packing=0.4", "discs.count=7"},
          Texts{"discs.packing=0.1", "discs.count=1"},
          Texts{"discs.packing=0.35", "discs.count=600", "discs.velocities=uniform"},
          Texts{"discs.packing=0.45", "box.left.kind=periodic", "box.right.kind=periodic"},
          Texts{"discs.packing=0.49", "box.left.kind=periodic", "box.right.kind=periodic",
                "box.bottom.kind=periodic", "box.top.kind=periodic"},
          Texts{"discs.packing=0.45", "discs.count=25", "discs.seed=2"},
          Texts{"discs.packing=0.4", "discs.count=9", "box.bottom.kind=periodic",
                "box.top.kind=periodic"},
          Texts{"discs.packing=0.4", "discs.count=600", "box.left.kind=periodic",
                "box.right.kind=periodic", "box.bottom.kind=periodic", "box.top.kind=periodic"}}) {
        CAPTURE(overrides);
        const SceneParameters scene = scene_of(overrides);
        const Discs by_the_rule = inserted_by_the_rule(scene);
        for (const int n_threads : {1, 3})
            check_generated(initial_state(scene, nullptr, ranks(), n_threads), by_the_rule);
    }
}

TEST_CASE("random insertion of several sizes follows its rule") {
    const SceneParameters scene = read_scene(
        "[box]\nsize = 10\n[discs]\nspeed = 0.25\nspecies = [{count = 30, radius = 0.5}, "
        "{count = 150, radius = 0.12}, {count = 50, radius = 0.3}]\n[time]\nsteps = 1\n",
        "s.toml");
    const Discs by_the_rule = inserted_by_the_rule(scene);
    for (const int n_threads : {1, 3})
        check_generated(initial_state(scene, nullptr, ranks(), n_threads), by_the_rule);
}

TEST_CASE("many random discs: all there, inside, apart, and always the same") {
    const SceneParameters scene = scene_of({"discs.packing=0.3", "discs.count=20000"});
    const Discs discs = initial_state(scene, nullptr, ranks());
    check_arrangement(discs, scene);
    CHECK(to_string(hash_of_all(discs)) == "ea31e7e50301b163d8a497ecbb08f66d");
}

TEST_CASE("random discs are shared out evenly") {
    const Discs discs = initial_state(scene_of({"discs.packing=0.3", "discs.count=20000"}), nullptr,
                                      ranks());
    const std::uint64_t share = 20000 / static_cast<std::uint64_t>(ranks().size());
    CHECK(discs.size() < share + share / 5);
}

TEST_CASE("a lattice is its sites, shaken") {
    const SceneParameters scene = scene_of(
        {"discs.packing=0.8", "discs.count=3000", "discs.generator=lattice"});
    const auto lattice = widest_lattice(scene.n_discs, scene.box, scene.radius);
    REQUIRE(lattice.has_value());
    Discs reference;
    for (DiscId id = 0; id < scene.n_discs; ++id) {
        const Point place = shaken_site(*lattice, id, scene.seed);
        reference.push_back({id, place.x, place.y, 0, 0});
    }
    give_velocities_by_hand(scene, reference);
    const Discs discs = initial_state(scene, nullptr, ranks());
    check_generated(discs, reference);
    check_arrangement(discs, scene);
}

TEST_CASE("a triangular lattice is its sites, row after row, along either edge") {
    const double height = std::sqrt(0.75);
    for (const bool stands : {false, true}) {
        Texts overrides = {"discs.generator=triangular", "discs.count=480", "discs.packing=0.9"};
        overrides.push_back(stands ? fmt::format("box.size=[{}, 30]", 16 * height)
                                   : fmt::format("box.size=[30, {}]", 16 * height));
        for (const char* side : {"left", "right", "bottom", "top"})
            overrides.push_back(fmt::format("box.{}.kind=periodic", side));
        const SceneParameters scene = scene_of(overrides);
        Discs reference;
        for (DiscId id = 0; id < 480; ++id) {
            const double row = std::floor(static_cast<double>(id) / 30);
            const double along = static_cast<double>(id % 30) +
                                 (std::fmod(row, 2) == 0 ? 0.25 : 0.75),
                         across = (row + 0.5) * height;
            reference.push_back({id, stands ? across : along, stands ? along : across, 0, 0});
        }
        give_velocities_by_hand(scene, reference);
        const Discs all = all_by_id(initial_state(scene, nullptr, ranks()));
        if (!ranks().is_root()) continue;
        REQUIRE(all.size() == 480);
        double farthest = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            CHECK(all[i].id == i);
            farthest = std::max({farthest, std::fabs(all[i].x - reference[i].x),
                                 std::fabs(all[i].y - reference[i].y),
                                 std::fabs(all[i].vx - reference[i].vx),
                                 std::fabs(all[i].vy - reference[i].vy)});
        }
        CHECK(farthest < 1e-13);
    }
}

TEST_CASE("the legacy generator gives the course program's discs") {
    struct Case {
        std::uint64_t n;
        double box;
    };
    for (const auto& [n, box] : {Case{1000, 20000}, Case{300, 48.5}, Case{1, 2}, Case{1500, 100}}) {
        CAPTURE(n, box);
        const SceneParameters scene = read_scene(fmt::format("{}\n{}\n1\n10\nperf\n", n, box),
                                                 "t.in");
        check_same(initial_state(scene, nullptr, ranks()), legacy_by_hand(n, box, 1));
    }
}

TEST_CASE("a box too full for the legacy generator is refused on every rank") {
    const SceneParameters scene = read_scene("100\n20\n1\n10\nperf\n", "t.in");
    CHECK_THROWS_AS(initial_state(scene, nullptr, ranks()), InputError);
}

TEST_CASE("streams reach generated discs of every kind") {
    for (const char* generator : {"random", "lattice", "legacy"}) {
        CAPTURE(generator);
        const Texts settings = {"discs.packing=0.2", fmt::format("discs.generator={}", generator)};
        Texts with_stream = settings;
        with_stream.push_back("discs.streams=[{region = [0, 0, 10, 5], velocity = [3, -4]}]");
        const Discs still = all_by_id(initial_state(scene_of(settings), nullptr, ranks()));
        const Discs moved = all_by_id(initial_state(scene_of(with_stream), nullptr, ranks()));
        CHECK(still.size() == moved.size());
        bool all_right = true;
        for (std::size_t i = 0; i < moved.size(); ++i) {
            const double share = still[i].y <= 5 ? 1 : 0;
            all_right = all_right &&
                        moved[i] == InputDisc{i, still[i].x, still[i].y, still[i].vx + 3 * share,
                                              still[i].vy - 4 * share};
        }
        CHECK(all_right);
    }
}

TEST_CASE("listed discs arrive, whatever their order, in shares") {
    std::string text = "150000\n1000\n0.5\n1\nperf\n";
    Discs reference;
    for (DiscId i = 0; i < 150000; ++i) {
        const DiscId id = i * 7919 % 150000;
        reference.push_back({id, 1 + 0.006 * static_cast<double>(id), 500, 0.25, -0.5});
        text += fmt::format("{} {} 500 0.25 -0.5\n", id, reference.back().x);
    }
    Listing listing = listing_of(text);
    const Discs discs = initial_state(listing.scene, listing.stream.get(), ranks());
    check_same(discs, reference);
    CHECK(discs.size() <= 150000 / static_cast<std::size_t>(ranks().size()) + 1);
}

TEST_CASE("discs listed in the scene are spread once") {
    const SceneParameters scene = scene_of(
        {"discs.list=[[1,1,0,0],[2,2,1,0],[3,3,0,1]]", "discs.count=3"});
    check_same(initial_state(scene, nullptr, ranks()), scene.listed_discs);
}

TEST_CASE("wrong lines are the same problems on every rank") {
    Listing listing = listing_of(
        "4\n10\n1\n1\nperf\n0 5 5 0 0\n1 5 5 x 0\n0 2 2 0 0\n2 0.5 5 0 0\n");
    std::vector<std::string> problems;
    try {
        initial_state(listing.scene, listing.stream.get(), ranks());
    } catch (const InputError& error) {
        for (const Problem& problem : error.problems())
            problems.push_back(problem.place + ':' + std::to_string(problem.line));
    }
    CHECK(problems == Texts{"t.in:7", "t.in:8", "t.in:9", "t.in:0"});
}

TEST_CASE("a start that jams gives way to the next one on any number of ranks") {
    std::size_t n_jams = 0;
    const int n_seeds = ranks().size() == 1 ? 6 : 2; // a jam takes a thousand rounds of messages
    for (int seed = 1; seed <= n_seeds; ++seed) {
        CAPTURE(seed);
        SceneParameters scene = scene_of({"discs.radius=2.05", "discs.count=4",
                                          "discs.generator=lattice",
                                          fmt::format("discs.seed={}", seed)});
        // the reader of scenes rejects this generator at such a packing
        scene.generator = Generator::random;
        const Discs by_the_rule = inserted_by_the_rule(scene);
        // If the first start jams, the result is the one without this start.
        const Point without_first = places_by_the_rule(scene, 1).front();
        n_jams += by_the_rule.front().x == without_first.x &&
                  by_the_rule.front().y == without_first.y;
        for (const int n_threads : {1, 3})
            check_generated(initial_state(scene, nullptr, ranks(), n_threads), by_the_rule);
    }
    CHECK(n_jams > 0);
}

TEST_CASE("discs that jam in every try are refused on every rank") {
    // a jam takes a hundred thousand rounds of messages, and more ranks test nothing new
    if (ranks().size() > 2) return;
    SceneParameters scene = scene_of(
        {"discs.radius=2.49", "discs.count=4", "discs.generator=lattice"});
    // the reader of scenes rejects this generator at such a packing
    scene.generator = Generator::random;
    CHECK_THROWS_AS(initial_state(scene, nullptr, ranks()), InputError);
}
