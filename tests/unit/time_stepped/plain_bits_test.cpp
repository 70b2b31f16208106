// SPDX-License-Identifier: BSD-3-Clause
// Dynamics compared with each other, bit by bit, on random discs near contact and near walls. An
// effect whose parameters switch it off gives the plain bits, and so do the settings of the
// accuracy study that runs use.
#include <cmath>
#include <cstring>
#include <random>

#include "catch.hpp"

#include "dynamics/all_dynamics.hpp"
#include "time_stepped/step_walls.hpp"

using namespace carrom;

namespace {

constexpr double box_size = 64, radius = 0.5;

/// Has a size and no other function.
struct Silent {
    double largest() const { return 1; }
    static constexpr double slack() { return 0; }
};
static_assert(!Bodies<Silent> && !Space<Silent> && !Bodies<WalledSpace> && !Space<EqualBodies>);

class Discs {
public:
    /// A disc anywhere in the box; one disc in four is at a wall.
    DiscState anywhere() {
        DiscState disc;
        disc.x = place();
        disc.y = place();
        disc.vx = velocity();
        disc.vy = velocity();
        disc.tau = uniform(0, 1);
        disc.id = next_id_++;
        return disc;
    }
    /// A disc at a distance of some diameters from `p`.
    DiscState near(const DiscState& p) {
        DiscState disc = anywhere();
        const double angle = uniform(0, 6.28), distance = uniform(0.9, 3) * 2 * radius;
        disc.x = p.x + distance * std::cos(angle);
        disc.y = p.y + distance * std::sin(angle);
        return disc;
    }

private:
    double uniform(double low, double high) {
        return std::uniform_real_distribution(low, high)(random_);
    }
    double velocity() { return uniform(-1, 1); }
    double place() {
        const double anywhere = uniform(radius, box_size - radius);
        return uniform(0, 1) < 0.25 ? uniform(0.5, 1) * 2 * radius : anywhere;
    }

    std::mt19937_64 random_{3210};
    DiscId next_id_ = 0;
};

bool are_same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
/// Compares the members that the hash contains; only dynamics that may lose energy use
/// `has_collided`.
bool are_same(DiscState a, DiscState b) {
    a.has_collided = b.has_collided = 0;
    return std::memcmp(&a, &b, sizeof a) == 0;
}
bool are_same(const auto& a, const auto& b)
    requires requires { a.delay; }
{
    return a.exists() == b.exists() &&
           (!a.exists() || (are_same(a.base, b.base) && are_same(a.delay, b.delay)));
}

struct Counts {
    int contacts = 0, bounces = 0, differences = 0;
};

/// Compares the results of both dynamics for many discs, and carries out the collisions that the
/// first one finds.
template <class A, class B> Counts compare(const A& a, const B& b, bool with_contact_times = true) {
    Discs discs;
    Counts counts;
    for (int k = 0; k < 20000; ++k) {
        const DiscState p = discs.anywhere(), q = discs.near(p);
        const auto found = a.contact(p, q, a.tolerance()), event = a.contact(p, q, never);
        bool same = true;
        if (with_contact_times)
            same = are_same(found, b.contact(p, q, b.tolerance())) &&
                   are_same(event, b.contact(p, q, never));
        if (event.exists()) {
            DiscState p1 = p, q1 = q, p2 = p, q2 = q;
            a.collide(p1, q1, event.base + event.delay, never);
            b.collide(p2, q2, event.base + event.delay, never);
            same = same && are_same(p1, p2) && are_same(q1, q2);
            ++counts.contacts;
        }
        const StepWalls a_walls(a);
        const StepWalls b_walls(b);
        const double t = a_walls.time(p, 0);
        same = same && are_same(t, b_walls.time(p, 0)) &&
               are_same(a.wall_time(p, Axis::x), b.wall_time(p, Axis::x)) &&
               are_same(a.wall_time(p, Axis::y), b.wall_time(p, Axis::y));
        if (t <= 1) {
            DiscState p1 = p, p2 = p;
            a_walls.bounce(p1, 0, t, nullptr);
            b_walls.bounce(p2, 0, t, nullptr);
            same = same && are_same(p1, p2);
            ++counts.bounces;
        }
        counts.differences += !same;
    }
    return counts;
}

void check_alike(const Counts& counts) {
    CHECK(counts.contacts > 1000);
    CHECK(counts.bounces > 1000);
    CHECK(counts.differences == 0);
}

} // namespace

TEST_CASE("effects that change nothing give the plain bits") {
    const PlainDynamics plain(box_size, radius);
    Effects effects;
    check_alike(compare(plain, WalledDynamics(box_size, radius, effects)));
    effects.contact = {ContactKind::restitution, 1};
    check_alike(compare(plain, WalledDynamics(box_size, radius, effects)));
    effects.species = {{1000, radius, 3}, {1000, radius, 3}};
    check_alike(compare(plain, WalledMixedDynamics(box_size, radius, effects)));
}

TEST_CASE("parts that change nothing give the plain bits") {
    const PlainDynamics plain(box_size, radius);
    check_alike(compare(plain, PeriodicDynamics(box_size, radius, Effects{})));
    check_alike(compare(plain, PeriodicMixedDynamics(box_size, radius, Effects{})));
    check_alike(compare(plain, GrowingDynamics(box_size, radius, Effects{})));
    check_alike(compare(plain, Dynamics<WalledSpace, GrowingBodies>(box_size, radius, Effects{})));
}

// Effects that do act change the results.
TEST_CASE("discs that grow touch earlier, and part faster") {
    Effects effects;
    effects.growth = 1e-3;
    const PlainDynamics plain(box_size, radius);
    const GrowingDynamics growing(box_size, radius, effects);
    Discs discs;
    int n_contacts = 0;
    for (int k = 0; k < 2000; ++k) {
        DiscState p = discs.anywhere(), q = discs.near(p);
        const auto then = plain.contact(p, q, never), now = growing.contact(p, q, never);
        if (!then.exists() || !now.exists() || then.delay == 0) continue;
        CHECK(now.delay < then.delay);
        growing.collide(p, q, now.base + now.delay, never);
        const double dx = q.x - p.x, dy = q.y - p.y, distance = std::hypot(dx, dy);
        // The centres must separate at least as fast as both radii grow.
        CHECK(((q.vx - p.vx) * dx + (q.vy - p.vy) * dy) / distance >=
              2 * radius * effects.growth * (1 - 1e-12));
        ++n_contacts;
    }
    CHECK(n_contacts > 300);
}

TEST_CASE("an effect that loses energy does not give the plain bits") {
    Effects effects;
    effects.contact = {ContactKind::restitution, 0.9};
    const Counts counts = compare(PlainDynamics(box_size, radius),
                                  WalledDynamics(box_size, radius, effects));
    CHECK(counts.differences > 1000);
}

TEST_CASE("in double precision the study's walls and collisions have the plain bits") {
    // In the study a contact does not count if rounding places it beyond touching.
    const bool with_contact_times = false;
    for (const ContactFormula formula :
         {ContactFormula::stable, ContactFormula::naive, ContactFormula::naive_contracted})
        check_alike(compare(PlainDynamics(box_size, radius),
                            StudyDynamics<double>(box_size, radius, {}, formula),
                            with_contact_times));
}

TEST_CASE("the study's states in single precision are floats near the plain ones") {
    const PlainDynamics plain(box_size, radius);
    const StudyDynamics<float> single(box_size, radius, {}, ContactFormula::stable);
    Discs discs;
    int n_contacts = 0;
    for (int k = 0; k < 20000; ++k) {
        DiscState p = discs.anywhere(), q = discs.near(p);
        StudyDynamics<float>::round(p);
        StudyDynamics<float>::round(q);
        const auto found = single.contact(p, q, never);
        const auto expected = plain.contact(p, q, never);
        if (!found.exists() || !expected.exists() || expected.delay > 1) continue;
        DiscState p1 = p, q1 = q;
        single.collide(p1, q1, static_cast<double>(found.base + found.delay), never);
        plain.collide(p, q, expected.base + expected.delay, never);
        for (const double number : {p1.x, p1.y, p1.vx, p1.vy, p1.tau, q1.x, q1.vx})
            REQUIRE(static_cast<double>(static_cast<float>(number)) == number);
        // A graze amplifies the rounding of positions, 2^-18, by at most its inverse root.
        CHECK(std::fabs(p1.x - p.x) < 0.02);
        CHECK(std::fabs(q1.vy - q.vy) < 0.05);
        ++n_contacts;
    }
    CHECK(n_contacts > 1000);
}
