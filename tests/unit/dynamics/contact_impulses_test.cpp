// SPDX-License-Identifier: BSD-3-Clause
// The impulses of lasting contacts compared with statics (columns, corners, slopes and three discs
// in a pile) and with Newton's third law in a moving heap.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "catch.hpp"

#include "dynamics/contact_impulses.hpp"

using namespace carrom;

namespace {

constexpr double g = 0.01, r = 0.5, interval = 2;

Effects under_gravity(double gx, double gy) {
    Effects effects;
    effects.contact = {ContactKind::rough, 0.9, 0.001, 0, 0.5, 0.5};
    effects.gravity = {gx, gy};
    effects.lasting_speed = 0.1;
    return effects;
}

/// A heap of discs, for which contact dynamics runs for some syncs.
struct Heap {
    std::vector<HeapDisc> discs;
    std::vector<KeptImpulse> kept;
    LastingForces forces;
    std::vector<HeapDisc> start = discs; ///< the discs at the start

    void run(const Effects& effects, const SpeciesTable& species, int n_syncs) {
        const ContactImpulses impulses(Box(100), effects, species, interval);
        const double gx = effects.gravity.x, gy = effects.gravity.y;
        for (int k = 0; k < n_syncs; ++k) {
            forces = impulses.act(discs, kept);
            for (HeapDisc& disc : discs) {
                disc.x += disc.vx * interval + 0.5 * gx * interval * interval;
                disc.y += disc.vy * interval + 0.5 * gy * interval * interval;
                disc.vx += gx * interval;
                disc.vy += gy * interval;
            }
        }
    }
    double moved(std::size_t i) const {
        return std::hypot(discs[i].x - start[i].x, discs[i].y - start[i].y);
    }
    std::size_t count_held() const {
        std::size_t n = 0;
        for (std::size_t i = 0; i < discs.size(); ++i) n += moved(i) < 0.05 * r ? 1 : 0;
        return n;
    }
};

/// The discs after 60 syncs, during which a free disc would fall by 144 radii.
Heap heap_after(std::vector<HeapDisc> discs, const Effects& effects) {
    Heap heap{std::move(discs), {}, {}};
    heap.run(effects, SpeciesTable(effects.species, r), 60);
    return heap;
}

/// Two discs that touch each other on the floor, and one on top of both.
Heap pile(double of_pairs, double of_floor) {
    Effects effects = under_gravity(0, -g);
    effects.contact.friction = of_pairs;
    effects.boundaries[2].surface = {0, of_floor, 0};
    return heap_after({{0, 50, r}, {1, 51, r}, {2, 50.5, r + std::sqrt(3) * r}}, effects);
}

} // namespace

TEST_CASE("lasting contacts: a column holds itself and presses the floor with its weight") {
    Effects effects = under_gravity(0, -g);
    double weight = 0;
    std::vector<HeapDisc> discs;
    for (DiscId id = 0; id < 8; ++id) {
        const double mass = id % 3 == 0 ? 2 : 1;
        effects.species.push_back({1, r, mass});
        discs.push_back({id, 50, r + 2 * r * static_cast<double>(id)});
        weight += mass * g;
    }
    Heap heap = heap_after(discs, effects);
    CHECK(heap.count_held() == 8);
    CHECK(heap.forces.walls[2].normal == Approx(weight * interval).epsilon(0.005));
    CHECK(heap.forces.walls[2].along == 0);
    for (const std::size_t side : {0u, 1u, 3u}) CHECK(heap.forces.walls[side].normal == 0);
    const std::vector<HeapDisc> before = heap.discs;
    const std::vector<KeptImpulse> kept = heap.kept;
    heap.run(effects, SpeciesTable(effects.species, r), 7);
    CHECK(heap.discs == before); // equal bit by bit
    CHECK(heap.kept == kept);
    CHECK(heap.forces.n_sweeps == 0);
}

TEST_CASE("lasting contacts: a corner holds a disc with the components of its weight") {
    const Heap heap = heap_after({{0, r, r}}, under_gravity(-0.3 * g, -g));
    CHECK(heap.count_held() == 1);
    CHECK(heap.forces.walls[0].normal == Approx(0.3 * g * interval).epsilon(0.01));
    CHECK(heap.forces.walls[2].normal == Approx(g * interval).epsilon(0.01));
}

TEST_CASE("lasting contacts: a disc rolls down a slope as mechanics says, and rests between two") {
    Effects effects = under_gravity(0, -g);
    effects.fixed_bodies.segments = {{10, 90, 50, 50}, {50, 50, 90, 90}};
    const double away = std::sqrt(0.5) * r;
    for (const double friction : {0.0, 0.2, 0.9}) {
        effects.fixed_bodies.surface = {0, friction, 0};
        Heap heap{{{0, 30 + away, 70 + away}}, {}, {}};
        heap.run(effects, SpeciesTable({}, r), 30);
        // sin 45 = cos 45. The disc rolls if the friction coefficient is at least a third of the
        // slope's tangent.
        const double pull = std::sqrt(0.5) * g,
                     expected = friction > 1.0 / 3 ? pull * 2 / 3 : pull * (1 - friction);
        const double time = 30 * interval;
        CHECK(heap.moved(0) == Approx(0.5 * expected * time * time).epsilon(0.02));
    }
    CHECK(heap_after({{0, 50, 50 + std::sqrt(2) * r}}, effects).count_held() == 1);
}

// The forces of the upper disc pass through the points where the lower discs touch the floor. So
// their angle to the line of centres is half of 30 degrees, and pairs need a coefficient of tan(15
// degrees), the floor a third of that.
TEST_CASE("lasting contacts: three discs in a pile need the friction that statics says") {
    const double needed = 2 - std::sqrt(3);
    CHECK(pile(1.1 * needed, 1.1 * needed / 3).count_held() == 3);
    CHECK(pile(0.9 * needed, 1).count_held() < 3);
    CHECK(pile(1, 0.9 * needed / 3).count_held() < 3);
    CHECK(pile(0, 0).count_held() == 0);
    CHECK(pile(1.1 * needed, 1).forces.walls[2].normal == Approx(3 * g * interval).epsilon(0.005));
}

TEST_CASE("lasting contacts: a floor that slides carries a disc as Coulomb says") {
    Effects effects = under_gravity(0, -g);
    effects.boundaries[2].surface = {0, 0.3, 0.4};
    Heap heap{{{0, 50, r}}, {}, {}};
    heap.run(effects, SpeciesTable({}, r), 10);
    // The disc slides, because its surface is slower than the floor's. It rests at the first sync,
    // not at the end of a fall, so this sync gives it half the impulse.
    const double time = 9.5 * interval;
    CHECK(heap.discs[0].vx == Approx(0.3 * g * time).epsilon(0.01));
    CHECK(heap.forces.walls[2].along == Approx(0.3 * g * interval).epsilon(0.01));
}

TEST_CASE("lasting contacts: pairs and walls give what changes the momentum and the energy") {
    Effects effects = under_gravity(0, -g);
    effects.boundaries[2].surface = {0, 0.5, 0.3};
    std::vector<HeapDisc> discs;
    for (DiscId id = 0; id < 60; ++id) {
        const auto row = static_cast<double>(id / 10), column = static_cast<double>(id % 10);
        discs.push_back({id, 40 + 1.003 * column + 0.5 * std::fmod(row, 2), r + 0.88 * row,
                         0.01 * (std::fmod(7 * column + row, 5) - 2), -0.02, 0.01 * column});
    }
    double px = 0, py = 0, energy = 0;
    const auto energy_of = [](const HeapDisc& disc) {
        return 0.5 * (disc.vx * disc.vx + disc.vy * disc.vy);
    };
    for (const HeapDisc& disc : discs) px -= disc.vx, py -= disc.vy, energy -= energy_of(disc);
    std::vector<KeptImpulse> kept;
    const LastingForces forces =
        ContactImpulses(Box(100), effects, SpeciesTable({}, r), interval).act(discs, kept);
    for (const HeapDisc& disc : discs) px += disc.vx, py += disc.vy, energy += energy_of(disc);
    double given = forces.walls[2].energy;
    for (const PairImpulse& pair : forces.pairs) {
        CHECK(pair.p < pair.q);
        CHECK(discs[pair.p].x + pair.dx == Approx(discs[pair.q].x));
        CHECK(discs[pair.p].y + pair.dy == Approx(discs[pair.q].y));
        given += pair.ix * (pair.p_vx - pair.q_vx) + pair.iy * (pair.p_vy - pair.q_vy);
    }
    CHECK(forces.walls[2].energy > 0);
    CHECK(given == Approx(energy).epsilon(0.01));
    CHECK(forces.pairs.size() > 40);
    CHECK(px == Approx(forces.walls[2].along).margin(0.01 * 60 * g * interval));
    CHECK(py == Approx(forces.walls[2].normal).margin(0.01 * 60 * g * interval));
}

TEST_CASE("lasting contacts: cells find the pairs, walls and obstacles that are near") {
    for (const bool is_periodic : {false, true}) {
        Effects effects = under_gravity(0, -g);
        if (is_periodic)
            effects.boundaries[0].kind = effects.boundaries[1].kind = BoundaryKind::periodic;
        effects.fixed_bodies.discs = {{20, 30, 7}, {60, 10, 1}};
        effects.fixed_bodies.segments = {{5, 80, 90, 20}};
        std::vector<HeapDisc> discs;
        std::vector<double> radii;
        for (DiscId id = 0; id < 2000; ++id) {
            const auto k = static_cast<double>(id);
            discs.push_back(
                {id, 100 * std::fmod(0.754877666 * k, 1), 100 * std::fmod(0.569840291 * k, 1)});
            radii.push_back(0.3 + 0.8 * std::fmod(0.618 * k, 1));
        }
        const double gap = 0.3;
        std::size_t n = 0;
        const auto count = [&](double dx, double dy, double touching) {
            n += std::hypot(dx, dy) < touching + gap ? 1 : 0;
        };
        for (std::size_t i = 0; i < discs.size(); ++i) {
            const HeapDisc& disc = discs[i];
            for (std::size_t j = i + 1; j < discs.size(); ++j) {
                double dx = discs[j].x - disc.x;
                if (is_periodic) dx -= 100 * std::round(dx / 100);
                count(dx, discs[j].y - disc.y, radii[i] + radii[j]);
            }
            count(disc.x - 20, disc.y - 30, radii[i] + 7);
            count(disc.x - 60, disc.y - 10, radii[i] + 1);
            const double share = std::clamp(
                ((disc.x - 5) * 85 - (disc.y - 80) * 60) / (85.0 * 85 + 60.0 * 60), 0.0, 1.0);
            count(disc.x - 5 - 85 * share, disc.y - 80 + 60 * share, radii[i]);
            if (!is_periodic) {
                count(disc.x, 0, radii[i]);
                count(100 - disc.x, 0, radii[i]);
            }
            count(disc.y, 0, radii[i]);
            count(100 - disc.y, 0, radii[i]);
        }
        CHECK(LastingContactFinder(Box(100), effects).find(discs, radii, gap).size() == n);
    }
}

TEST_CASE("lasting contacts: a contact has the friction of its pair of species") {
    constexpr double common = std::numeric_limits<double>::quiet_NaN();
    Effects effects = under_gravity(0, -g);
    effects.contact.friction = 0.3;
    effects.contact.rows = {{1, 0}, {3, 1}, {4, 2}};
    effects.contact.pairs = {{2, 1, common, common, 0.7}, {2, 2, common, -1, 0.9}};
    std::vector<HeapDisc> discs;
    for (DiscId id = 0; id < 4; ++id)
        discs.push_back({id, 20 + 2 * r * static_cast<double>(id), 50});
    const std::vector<double> radii(discs.size(), r);
    const double expected[] = {0.7, 0, 0.3}; // a smooth pair, and a pair without a row
    const auto found = LastingContactFinder(Box(100), effects).find(discs, radii, 0.1 * r);
    REQUIRE(found.size() == 3);
    for (const LastingContact& one : found) CHECK(one.friction == expected[one.a]);
}
