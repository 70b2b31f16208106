// SPDX-License-Identifier: BSD-3-Clause
// The self-check at the end of a step: of correct states in every scene of the tests, and of states
// with one error. Errors are made in a copy, because the engines cannot be made to fail.
#include "check/state_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "check_runs.hpp"

using namespace carrom;
using namespace carrom::test;

TEST_CASE("check: nothing is wrong in the scenes of the tests") {
    const Communicator world = Communicator::world();
    std::size_t number = 0;
    for (const TestScene& scene : small_scenes()) {
        ++number;
        for (const Method method : both) {
            if (is_left_to_others(number + (method == Method::time_stepped))) continue;
            if (method == Method::event_driven &&
                (scene.cascades_when_event_driven || scene.discs.size() > 100))
                continue;
            INFO(scene.name << (method == Method::time_stepped ? ", one" : ", all"));
            CHECK(failure_of(scene, method, world) == "");
        }
    }
}

TEST_CASE("check: nothing is wrong in a step that is not spoilt") {
    for (const Method method : both) CHECK(!OneStep(method).inspect().has_value());
}

TEST_CASE("check: a number that is not finite") {
    expect(Invariant::finite, [](OneStep& step) {
        if (DiscState* const disc = step.own(7)) disc->y = std::numeric_limits<double>::quiet_NaN();
        return 7;
    });
}

TEST_CASE("check: a disc that nobody owns any more") {
    expect(Invariant::owned_once, [](OneStep& step) {
        if (DiscState* const disc = step.own(7)) {
            std::swap(*disc, step.local_view.discs[step.local_view.n_own - 1]);
            --step.local_view.n_own;
        }
        return 7;
    });
}

TEST_CASE("check: a disc that is owned twice") {
    expect(Invariant::owned_once, [](OneStep& step) {
        if (step.own(8)) step.own(8)->id = 7; // disc 8 is missing, too, but 7 comes first
        return 7;
    });
}

TEST_CASE("check: a disc that does not exist") {
    expect(Invariant::owned_once, [](OneStep& step) -> std::optional<DiscId> {
        if (step.own(0)) step.own(0)->id = 64;
        return std::nullopt;
    });
}

TEST_CASE("check: a disc outside the box, by little") {
    expect(Invariant::in_box, [](OneStep& step) {
        const double size = step.scene().box.x;
        if (DiscState* const disc = step.own(7))
            disc->y += (size - step.scene().radius) * (1 + 1e-12) -
                       disc->y_at(step.local_view.time);
        return 7;
    });
}

TEST_CASE("check: a disc in another rank's domain") {
    if (Communicator::world().size() == 1) return;
    expect(Invariant::in_domain, [](OneStep& step) {
        if (DiscState* const disc = step.own(7)) {
            const double from_left = step.scene().radius,
                         from_right = step.scene().box.x - step.scene().radius;
            const bool is_left = step.local_view.domains.owner(from_left, 0) == step.world().rank();
            disc->x += (is_left ? from_right : from_left) - disc->x_at(step.local_view.time);
        }
        return 7;
    });
}

TEST_CASE("check: a disc in another cell than it is filed under") {
    expect(Invariant::in_cell, [](OneStep& step) {
        if (DiscState* const disc = step.own(7)) {
            const double y = disc->y_at(step.local_view.time),
                         width = step.local_view.grid.geometry().cell_width;
            disc->y += y > step.scene().box.x / 2 ? -width : width;
        }
        return 7;
    });
}

TEST_CASE("check: collisions that are counted but have not happened") {
    expect(Invariant::counters, [](OneStep& step) {
        if (step.own(7)) ++step.own(7)->wall_collisions;
        return 7;
    });
    expect(Invariant::counters, [](OneStep& step) {
        if (step.own(7)) ++step.own(7)->pair_collisions;
        return 7;
    });
}

TEST_CASE("check: a pair's collision that one of the two has not counted") {
    expect(Invariant::counters, [](OneStep& step) {
        const DiscId q = step.first_pair().q;
        if (step.own(q)) --step.own(q)->pair_collisions;
        return q;
    });
}

TEST_CASE("check: a collision that is not in the log") {
    expect(Invariant::counters, [](OneStep& step) {
        const Collision lost = step.first_pair();
        std::erase_if(step.log, [&](const Collision& c) {
            return c.p == lost.p && c.q == lost.q && c.time == lost.time;
        });
        return lost.p;
    });
}

TEST_CASE("check: a velocity that has changed without a collision") {
    expect(Invariant::motion, [](OneStep& step) {
        const DiscId id = step.free_disc();
        if (DiscState* const disc = step.own(id)) disc->vx = std::nextafter(disc->vx, 10);
        return id;
    });
}

TEST_CASE("check: energy that a collision has made up") {
    expect(Invariant::energy, [](OneStep& step) -> std::optional<DiscId> {
        const Collision pair = step.first_pair();
        if (step.own(pair.p)) step.own(pair.p)->vx *= 1 + 1e-11;
        return std::nullopt;
    });
}
