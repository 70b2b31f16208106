// SPDX-License-Identifier: BSD-3-Clause
// Reports of the self-check about two discs that fly into each other, as if an engine had missed
// their contact.
#include "check/state_check.hpp"

#include <memory>
#include <span>
#include <vector>

#include "catch.hpp"

#include "local_discs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Method both[] = {Method::time_stepped, Method::event_driven};

/// Two discs of radius 1 in a box of 20 whose contact has not been found: disc 0 flies to the
/// right, disc 1 rests or flies.
struct Passing {
    Communicator world = Communicator::world();
    SceneParameters scene;
    std::vector<DiscState> discs{2};
    std::unique_ptr<StateCheck> check;
    std::int64_t step = 0;

    Passing(Method method, double x, double speed) {
        scene.name = "two discs";
        scene.box = 20;
        scene.radius = 1;
        scene.n_discs = 2;
        scene.method = method;
        discs[0].x = x;
        discs[0].vx = speed;
        discs[1].x = 9.5;
        discs[1].id = 1;
        discs[0].y = discs[1].y = 10;
        const LocalDiscs local_view = at(0);
        check = std::make_unique<StateCheck>(scene, SpeciesTable({}, scene.radius),
                                             std::span(local_view.discs).first(local_view.n_own), 0,
                                             world);
    }
    LocalDiscs at(double time) const {
        return view_by_hand(discs, time, 20, 1, world.rank(), world.size());
    }

    /// Whether the check accepts the end of the next step. `walls` is the number of disc 0's wall
    /// collisions that are counted and logged in the step.
    bool is_right(std::uint64_t walls = 0) {
        std::vector<Collision> log;
        discs[0].wall_collisions = (discs[0].wall_collisions + walls) & 0x7fffffffffff;
        if (world.is_root()) log.assign(walls, {step, 0.5, 0, 0, Collision::wall, 0});
        ++step;
        try {
            check->inspect(at(static_cast<double>(step)).view(), step, log);
        } catch (const CheckFailure& failure) {
            CHECK(failure.invariant == Invariant::overlap);
            CHECK(failure.disc == 0);
            CHECK(failure.step == step);
            return false;
        }
        return true;
    }
};

} // namespace

TEST_CASE("check: an overlap that comes about while both are free is not explained") {
    for (const Method method : both) {
        Passing passing(method, 5, 1); // contact after 2.5 steps
        CHECK(passing.is_right());
        CHECK(passing.is_right());
        CHECK(!passing.is_right());
    }
}

TEST_CASE("check: a contact lost at the boundary of two steps is not explained") {
    for (const Method method : both) {
        Passing passing(method, 5.5, 1); // contact after 2 steps
        CHECK(passing.is_right());
        CHECK(passing.is_right());
        CHECK(!passing.is_right());
    }
}

TEST_CASE("check: discs so slow that an overlap deepens by less than its bound a step are found "
          "all the same") {
    Passing passing(Method::time_stepped, 7.5 - 1e-11, 5e-14);
    bool is_right = true;
    while (is_right && passing.step < 3000) is_right = passing.is_right();
    CHECK(!is_right);
}

TEST_CASE("check: the time-stepped method explains overlaps with a disc that has had its "
          "collision, the rule "
          "all none") {
    Passing one(Method::time_stepped, 6.7, 1);
    CHECK(one.is_right(1));
    CHECK(one.is_right()); // the discs fly on through each other
    CHECK(one.is_right());
    Passing all(Method::event_driven, 6.7, 1);
    CHECK(!all.is_right(1));
}

TEST_CASE("check: a collision in an earlier step explains nothing") {
    Passing passing(Method::time_stepped, 5.7, 1); // contact after 1.8 steps
    CHECK(passing.is_right(1));
    CHECK(!passing.is_right());
}

TEST_CASE("check: discs that overlap from the start may, under the time-stepped method") {
    Passing passing(Method::time_stepped, 8, 0.25);
    for (int k = 0; k < 5; ++k) CHECK(passing.is_right());
}
