// SPDX-License-Identifier: BSD-3-Clause
// Swap moves of discs that do not move. Each round is its own inverse, and all assignments of radii
// without overlaps are equally frequent. Neighbours are found by brute force.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "catch.hpp"

#include "problems_of.hpp"
#include "scene/effects/effect.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;
using test::has;
using test::problems_of;

namespace {

struct Centre {
    double x = 0, y = 0;
};

/// The surroundings of the discs: walls of the box, and an obstacle.
struct Around {
    bool has_walls = false;
    std::optional<FixedDisc> disc = {};
};

/// Discs of one rank on which effects act, in a box of 12 x 12.
class Fixed {
public:
    Fixed(const std::vector<Centre>& places, const std::vector<double>& radii, std::int64_t rounds,
          const Around& around = {})
        : places_(places), radii_(radii), around_(around) {
        scene_.n_discs = places.size();
        scene_.box = {size, size};
        if (!around.has_walls) scene_.effects.boundaries.fill({BoundaryKind::periodic, 1, 0, 0});
        if (around.disc) scene_.effects.fixed_bodies.discs.push_back(*around.disc);
        scene_.method = Method::event_driven;
        scene_.effects.swap = {rounds, 0, 5};
        for (const double radius : radii) scene_.effects.species.push_back({1, radius, 1});
        scene_.radius = *std::ranges::max_element(radii);
        table_ = SpeciesTable(scene_.effects.species, scene_.radius, true);
        for (DiscId id = 0; id < places.size(); ++id) {
            discs_.emplace_back(DiscState{});
            discs_.back().id = id;
            discs_.back().x = places[id].x;
            discs_.back().y = places[id].y;
        }
        effects_ = sync_effects_of(scene_);
        REQUIRE(effects_.size() == 1);
        effects_[0]->learn(table_);
    }

    void act(std::int64_t n_syncs) {
        SyncDiscs at{table_};
        at.discs = discs_;
        at.radii = radii_;
        at.n_syncs = n_syncs;
        at.in_parts = [&](const SyncDiscs::Part& part) { part(0, discs_.size()); };
        at.gather_over_ranks = [](std::span<const std::byte> mine) {
            return std::vector<std::byte>(mine.begin(), mine.end());
        };
        const double reach = effects_[0]->reach(n_syncs);
        at.visit_near_pairs = [&](const SyncDiscs::VisitNear& visit) {
            for (std::size_t i = 0; i < places_.size(); ++i)
                for (std::size_t j = 0; j < places_.size(); ++j)
                    if (i != j && distance(i, j) <= reach) visit(i, j, distance(i, j));
        };
        effects_[0]->act(at);
        for (std::size_t i = 0; i < radii_.size(); ++i) REQUIRE(radii_[i] == table_.of(i).radius);
    }

    const std::vector<double>& radii() const { return radii_; }
    bool do_overlap(const std::vector<double>& radii) const {
        for (std::size_t i = 0; i < radii.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (distance(i, j) < radii[i] + radii[j]) return true;
        for (std::size_t i = 0; i < radii.size(); ++i)
            if (is_too_large_for(places_[i], radii[i])) return true;
        return false;
    }

private:
    static constexpr double size = 12;

    bool is_too_large_for(const Centre& place, double radius) const {
        if (around_.has_walls &&
            std::min({place.x, size - place.x, place.y, size - place.y}) < radius)
            return true;
        return around_.disc && std::hypot(place.x - around_.disc->x, place.y - around_.disc->y) <
                                   radius + around_.disc->radius;
    }
    double distance(std::size_t i, std::size_t j) const {
        return std::hypot(places_[i].x - places_[j].x, places_[i].y - places_[j].y);
    }

    std::vector<Centre> places_;
    std::vector<double> radii_;
    Around around_;
    SceneParameters scene_;
    SpeciesTable table_{{}, 1};
    std::vector<DiscState> discs_;
    SyncEffects effects_;
};

/// Radii of 0.7 to 1.05 at the points of a square lattice with small random shifts.
Fixed lattice(std::int64_t rounds) {
    std::mt19937_64 random(3);
    const auto uniform = [&] { return std::ldexp(static_cast<double>(random() >> 11), -53); };
    std::vector<Centre> places;
    std::vector<double> radii;
    for (int x = 0; x < 20; ++x) {
        for (int y = 0; y < 20; ++y) {
            places.push_back({2.2 * x + 0.1 * uniform(), 2.2 * y + 0.1 * uniform()});
            radii.push_back((x + y) % 2 == 0 ? 0.7 + 0.3 * uniform() : 0.9 + 0.15 * uniform());
        }
    }
    return {places, radii, rounds};
}

} // namespace

TEST_CASE("A round of swaps is its own inverse, and no discs overlap after it") {
    Fixed discs = lattice(1);
    REQUIRE_FALSE(discs.do_overlap(discs.radii()));
    std::size_t n_moved = 0;
    for (std::int64_t sync = 1; sync <= 200; ++sync) {
        const std::vector<double> before = discs.radii();
        discs.act(sync);
        const std::vector<double> after = discs.radii();
        CHECK_FALSE(discs.do_overlap(after));
        discs.act(sync);
        CHECK(discs.radii() == before);
        discs.act(sync); // continues from the stored numbers
        for (std::size_t i = 0; i < before.size(); ++i) n_moved += before[i] != after[i];
        CHECK(std::multiset<double>(after.begin(), after.end()) ==
              std::multiset<double>(before.begin(), before.end()));
    }
    CHECK(n_moved > 1000);
}

namespace {

const std::vector<double> five_radii{0.6, 1.1, 0.8, 1.41, 0.89};

/// Five discs that do not move. In 30,000 nearly independent states each assignment of their radii
/// is equally frequent, and every assignment without overlaps occurs.
void check_all_ways(const std::vector<Centre>& places, const Around& around,
                    std::size_t n_expected) {
    Fixed discs(places, five_radii, 120, around);
    std::vector<double> way = five_radii;
    std::ranges::sort(way);
    std::map<std::vector<double>, int> counts;
    do
        if (!discs.do_overlap(way)) counts[way] = 0;
    while (std::next_permutation(way.begin(), way.end()));
    const std::size_t n_ways = counts.size();
    REQUIRE(n_ways == n_expected);
    REQUIRE_FALSE(discs.do_overlap(five_radii));
    constexpr int n = 30'000;
    for (std::int64_t sync = 1; sync <= n; ++sync) {
        discs.act(sync);
        const auto found = counts.find(discs.radii());
        REQUIRE(found != counts.end());
        ++found->second;
    }
    double chi_square = 0;
    const double expected = static_cast<double>(n) / static_cast<double>(n_ways);
    for (const auto& [radii_of_way, count] : counts)
        chi_square += (count - expected) * (count - expected) / expected;
    const auto freedom = static_cast<double>(n_ways - 1);
    CHECK(chi_square < freedom + 5 * std::sqrt(2 * freedom));
}

} // namespace

// Discs in a row have so little room that only 60 of the 120 assignments are possible.
TEST_CASE("All ways to deal out radii that do not overlap come equally often") {
    check_all_ways({{1, 6}, {3.02, 6}, {5.04, 6}, {7.56, 6}, {10.08, 6}}, {}, 60);
}

TEST_CASE("Walls and obstacles leave discs room or none") {
    // The first disc has a room of 1 because of the wall, the last one 1 because of the corner, and
    // the third 1.2 because of the obstacle. Positions are so far apart that discs do not touch.
    const std::vector<Centre> places{{1, 3}, {4, 3}, {8, 3}, {4, 7}, {11, 11}};
    check_all_ways(places, {true, {}}, 36);
    check_all_ways(places, {true, FixedDisc{8, 5.2, 1}}, 24);
    check_all_ways(places, {false, FixedDisc{8, 5.2, 1}}, 96);
}

TEST_CASE("Swaps are read, and refused where discs have no room or no sizes") {
    const std::string text =
        "[box]\nsize = 50\nleft.kind = 'periodic'\nright.kind = 'periodic'\nbottom.kind = "
        "'periodic'\ntop.kind = 'periodic'\n[time]\nsteps = 10\nmethod = "
        "'event-driven'\n[effects.swap]\nrounds = 3\nuntil_step = 5\nseed = 7\n";
    const std::string two = text + "[[discs.species]]\ncount = 3\nradius = 2\n[[discs.species]]\n"
                                   "count = 4\nradius = 1\nmass = 3\n";
    const SceneParameters scene = read_scene(two, "s.toml");
    CHECK(scene.effects.swap == Swaps{3, 5, 7});
    CHECK(first_number(scene, SideColumn::swapped_radius, 2) == 2);
    CHECK(first_number(scene, SideColumn::swapped_radius, 3) == 1);
    CHECK(has(summary_of(scene.effects), "3 rounds of swaps at each sync up to step 5"));
    const auto problems = [](const std::string& of, const std::vector<std::string>& overrides) {
        std::string all;
        for (const Problem& problem : problems_of([&] { read_scene(of, "s.toml", overrides); }))
            all += problem.text + '\n';
        return all;
    };
    CHECK(has(problems(text + "[discs]\ncount = 7\nradius = 1\n", {}),
              "cannot have swaps together with discs of one radius"));
    CHECK(has(problems(two, {"time.method=time-stepped"}), "together with time.method"));
    CHECK(problems(two, {"box.left.kind=wall", "box.right.kind=wall"}).empty());
    CHECK(
        has(problems(two, {"box.left.kind=moving", "box.right.kind=wall", "box.left.speed=0.001"}),
            "together with sides that move, are open or sheared"));
    CHECK(has(problems(two, {"box.left.kind=open", "box.right.kind=wall"}),
              "together with sides that move, are open or sheared"));
    CHECK(has(problems(two, {"effects.growth.rate=1e-9"}), "together with growing discs"));
    CHECK(has(problems(two, {"effects.swap.rounds=0"}), "no meaning without effects.swap.rounds"));
}
