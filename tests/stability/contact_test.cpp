// SPDX-License-Identifier: BSD-3-Clause
// Family 2, contact: pairs that touch to within ulps, and contacts on the boundaries of steps and
// windows.
//
// Why hard: after a collision rounding leaves a pair some ulp inside or outside contact. A program
// that then finds the same contact again, or none when the pair is pushed together, loses or
// repeats collisions. Source: Bannerman, Strobl, Formella, Poeschel, Comput. Part. Mech. 1, 191
// (2014): pairs that touch or overlap collide at once if they approach, and never if they separate.
// Bounds: exactly one collision of pairs that approach, none of others; no contact lost between two
// steps.
#include "catch.hpp"

#include <cmath>

#include "approach.hpp"
#include "dynamics/all_dynamics.hpp"
#include "hold.hpp"
#include "runs.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Method both[] = {Method::time_stepped, Method::event_driven};
constexpr int most_ulps = 64;

/// Every ulp on one rank; every eighth on several ranks, because starting and exchanging messages
/// takes long.
int ulp_step() { return Communicator::world().size() == 1 ? 1 : 8; }

double by_ulps(double value, int ulps) {
    for (int i = 0; i < std::abs(ulps); ++i)
        value = std::nextafter(value, ulps < 0 ? -1e300 : 1e300);
    return value;
}

/// A single pair in a box of eight diameters, at the distance sigma (1 + k ulp) along x, y or a
/// diagonal. It is near the origin, where an ulp of a coordinate is one of sigma, or far from it,
/// where it is four. The relative velocity is `closing` along the line of centres and `sliding`
/// across it.
TestScene pair_at_contact(int ulps, int direction, bool is_near, double closing, double sliding) {
    TestScene scene = empty_scene("pair at contact, " + std::to_string(ulps) + " ulp", 8, 0.5, 3);
    const double ex[] = {1, 0, 0.6, -0.8}, ey[] = {0, 1, 0.8, 0.6};
    const double cx = ex[direction], cy = ey[direction];
    const double x = is_near ? (cx < 0 ? 1.5625 : 0.75) : 3, y = is_near ? 0.75 : 3;
    const double qx = x + cx, qy = y + cy;
    add_disc(scene, x, y, 0.25, 0.125);
    // One coordinate changes by its own ulps; along an axis the distance is then exactly sigma (1 +
    // k ulp).
    add_disc(scene, direction == 0 ? by_ulps(qx, ulps) : qx,
             direction == 0 ? qy : by_ulps(qy, ulps), 0.25 - closing * cx - sliding * cy,
             0.125 - closing * cy + sliding * cx);
    return scene;
}

} // namespace

TEST_CASE("contact: pairs within 64 ulp of contact collide once if they approach and never if they "
          "separate",
          "[contact]") {
    for (const Method method : both) {
        double most = 0, fewest = 1, receding = 0;
        for (int ulps = -most_ulps; ulps <= most_ulps; ulps += ulp_step()) {
            for (int direction = 0; direction < 4; ++direction) {
                for (const bool is_near : {false, true}) {
                    for (const double speed : {0.25, 1e-3, 1e-9}) {
                        // At 1e-9 a pair with a gap slides apart before the gap closes, so it may
                        // but need not meet. On a diagonal the computed distance may be wrong by an
                        // ulp of sigma, and positions near the origin are as fine as that.
                        const bool must_meet = speed > 1e-6 ||
                                               ulps <= (direction < 2 || !is_near ? 0 : -3);
                        const auto collisions = [&](double closing) {
                            return static_cast<double>(
                                run(pair_at_contact(ulps, direction, is_near, closing, 0.1), method)
                                    .totals.pair_collisions);
                        };
                        const double approaching = collisions(speed);
                        most = std::max(most, approaching);
                        if (must_meet) fewest = std::min(fewest, approaching);
                        receding += collisions(-speed);
                    }
                }
            }
        }
        hold("contact", "sigma (1 +- 64 ulp), approaching: most collisions of a pair",
             name_of(method), most, 1);
        hold("contact", "sigma (1 +- 64 ulp), approaching: pairs that did not collide",
             name_of(method), 1 - fewest, 0);
        hold("contact", "sigma (1 +- 64 ulp), receding: collisions", name_of(method), receding, 0);
    }
}

// Along the tangent even the sign of b is uncertain. A collision is then harmless if its impulse is
// almost 0.
TEST_CASE("contact: pairs that slide along each other get no impulse to speak of", "[contact]") {
    for (const Method method : both) {
        double largest = 0;
        for (int ulps = -most_ulps; ulps <= most_ulps; ulps += ulp_step()) {
            for (int direction = 0; direction < 4; ++direction) {
                for (const bool is_near : {false, true}) {
                    const TestScene scene = pair_at_contact(ulps, direction, is_near, 0, 0.25);
                    for (const Collision& collision : collisions_of(scene, method))
                        largest = std::max(largest, collision.impulse);
                }
            }
        }
        hold("contact", "sigma (1 +- 64 ulp), sliding: largest impulse over relative speed",
             name_of(method), largest / 0.25, 1e-7);
    }
}

// The impulse is computed from the stored positions, so that the pair certainly separates (b > 0).
TEST_CASE("contact: a million random collisions leave no pair that approaches", "[contact]") {
    Approaches some(201);
    const PlainDynamics dynamics(64, 0.5);
    double n_again = 0;
    for (int i = 0; i < 1000000; ++i) {
        const double distance = some.log_uniform(1, 30), margin = some.log_uniform(1e-10, 1),
                     speed = some.log_uniform(1e-3, 10);
        const Approach c = some.make(distance, margin, speed, 1);
        DiscState p, q;
        p.x = 32 - c.dx / 2;
        p.y = 32 - c.dy / 2;
        q.x = 32 + c.dx / 2;
        q.y = 32 + c.dy / 2;
        q.id = 1;
        p.vx = some.uniform(-1, 1);
        p.vy = some.uniform(-1, 1);
        q.vx = p.vx + c.wx;
        q.vy = p.vy + c.wy;
        const PairContact<double> contact = dynamics.contact(p, q, never);
        if (!contact.exists()) continue;
        dynamics.collide(p, q, contact.base + contact.delay, never);
        const PairContact<double> next = dynamics.contact(p, q, never);
        n_again += next.exists() && next.delay < 1e-12;
    }
    hold("contact", "1e6 random collisions: pairs due to collide again at once", "both", n_again,
         0);
}

// Also for grazing pairs: in a run each pair collides once.
TEST_CASE("contact: lone pairs collide once in a run", "[contact]") {
    for (const Method method : both) {
        double most = 0, total = 0;
        Approaches some(202);
        for (int i = 0; i < 40; ++i) {
            TestScene scene = empty_scene("lone pairs", 160, 0.5, 6);
            for (int cell = 0; cell < 64; ++cell) {
                const double distance = some.uniform(1, 4), margin = some.log_uniform(1e-8, 1),
                             speed = some.uniform(0.5, 2);
                const Approach c = some.make(distance, margin, speed, 1);
                const double x = 10 + 20 * (cell % 8), y = 10 + 20 * (cell / 8);
                add_disc(scene, x - c.dx / 2, y - c.dy / 2, -c.wx / 2, -c.wy / 2);
                add_disc(scene, x + c.dx / 2, y + c.dy / 2, c.wx / 2, c.wy / 2);
            }
            const Outcome outcome = run(scene, method);
            for (const DiscState& disc : outcome.discs)
                most = std::max(most, static_cast<double>(disc.pair_collisions));
            total += static_cast<double>(outcome.totals.pair_collisions);
        }
        CHECK(total > 40 * 64 * 0.9);
        hold("contact", "2560 lone pairs, grazing to 1e-8: most collisions of a pair",
             name_of(method), most, 1);
    }
}

// Next to a boundary the same time is rounded in two ways. Between the two results no contact may
// be lost.
TEST_CASE("contact: none is lost on a step, sync or window boundary", "[contact]") {
    for (const Method method : both) {
        double lost = 0, n_contacts = 0;
        for (const TestScene& scene : boundary_contacts()) {
            for (const double window : {0.5, 1.0, 64.0}) {
                Tuning tuning;
                tuning.window = window;
                const auto expected = static_cast<double>(*scene.expected_pair_collisions);
                lost += std::fabs(
                    expected -
                    static_cast<double>(run(scene, method, tuning).totals.pair_collisions));
                n_contacts += expected;
            }
        }
        hold("contact",
             number(n_contacts) + " contacts on boundaries, L/r to 1e6: lost or repeated",
             name_of(method), lost, 0);
    }
}
