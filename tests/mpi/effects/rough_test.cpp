// SPDX-License-Identifier: BSD-3-Clause
// Rough discs: the references' bits, the plain dynamics' bits if they are smooth, and collisions by
// the laws of mechanics.
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "catch.hpp"

#include "core/state_hash.hpp"
#include "reference_bits.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

ContactEffect rough(double restitution, double tangential, double friction, double inertia = 0.5) {
    return {ContactKind::rough, restitution, 0.001, tangential, friction, inertia};
}

/// A disc as a rigid body.
struct Solid {
    long double x, y, vx, vy, spin, radius, mass, inertia; ///< inertia in units of m r^2

    long double moment() const { return inertia * mass * radius * radius; }
    long double energy() const {
        return 0.5L * mass * (vx * vx + vy * vy) + 0.5L * moment() * spin * spin;
    }
    /// Angular momentum about a point.
    long double angular_momentum(long double px, long double py) const {
        return mass * ((x - px) * vy - (y - py) * vx) + moment() * spin;
    }
};

/// Two spinning discs in an oblique collision, before and after it.
struct Meeting {
    std::array<Solid, 2> before, after;
};

Meeting meet(const ContactEffect& contact, Method method, const Communicator& world) {
    TestScene scene = empty_scene("two discs", 64, 3, 40);
    scene.setting.effects.contact = contact;
    scene.setting.effects.species = {{1, 3, 5}, {1, 1, 0.7}};
    scene.setting.sync_every = 64;
    add_disc(scene, 20, 30, 0.5, 0.05);
    add_disc(scene, 34, 31.5, -0.25, -0.01);
    SceneParameters all = scene_of(scene);
    all.method = method;
    StoredState state;
    const std::vector<double> spins{0.07, -0.3};
    if (world.is_root()) {
        for (const InputDisc& disc : scene.discs)
            state.discs.push_back({disc.x, disc.y, disc.vx, disc.vy, 0, disc.id, 0, 0});
        state.columns.add(SideColumn::spin, spins);
    }
    DiscSystem system(all, state, world, {});
    Meeting meeting;
    for (std::size_t k = 0; k < 2; ++k) {
        const InputDisc& disc = scene.discs[k];
        const Species& body = scene.setting.effects.species[k];
        meeting.before[k] = {disc.x,   disc.y,      disc.vx,   disc.vy,
                             spins[k], body.radius, body.mass, contact.inertia};
    }
    advance_to(system, 20);
    CHECK(system.totals().pair_collisions == 1);
    CHECK(system.totals().wall_collisions == 0);
    std::vector<std::array<double, 7>> mine;
    for (std::size_t i = 0; i < system.discs().size(); ++i) {
        const DiscState& disc = system.discs()[i];
        mine.push_back({static_cast<double>(disc.id), disc.x, disc.y, disc.vx, disc.vy,
                        system.spins()[i], disc.tau});
    }
    mine.resize(2, {-1, 0, 0, 0, 0, 0, 0});
    for (const auto& both : world.all_gather(std::array{mine[0], mine[1]})) {
        for (const auto& row : both) {
            if (row[0] < 0) continue;
            const auto k = static_cast<std::size_t>(row[0]);
            meeting.after[k] = meeting.before[k];
            meeting.after[k] = {row[1],
                                row[2],
                                row[3],
                                row[4],
                                row[5],
                                meeting.before[k].radius,
                                meeting.before[k].mass,
                                contact.inertia};
            meeting.before[k].x += meeting.before[k].vx * row[6]; // moves both to the contact
            meeting.before[k].y += meeting.before[k].vy * row[6];
        }
    }
    return meeting;
}

/// Normal and tangential relative velocity of the surfaces at the contact.
std::array<long double, 2> surface_velocity(const std::array<Solid, 2>& pair) {
    const long double ex = pair[1].x - pair[0].x, ey = pair[1].y - pair[0].y,
                      length = std::sqrt(ex * ex + ey * ey);
    const long double nx = ex / length, ny = ey / length, wx = pair[1].vx - pair[0].vx,
                      wy = pair[1].vy - pair[0].vy;
    return {wx * nx + wy * ny,
            -wx * ny + wy * nx - pair[0].spin * pair[0].radius - pair[1].spin * pair[1].radius};
}

double energy(const std::array<Solid, 2>& pair) {
    return static_cast<double>(pair[0].energy() + pair[1].energy());
}

} // namespace

TEST_CASE("effects: rough discs have the references' bits, alone and with other effects") {
    for (TestScene scene : base_scenes()) {
        Effects& effects = scene.setting.effects;
        for (const ContactEffect& contact :
             {rough(0.9, 0.4, 0.3), rough(1, 1, no_limit), rough(0.6, -0.5, 1, 1)}) {
            effects = {};
            effects.contact = contact;
            for (const Method method : {Method::time_stepped, Method::event_driven})
                check_bits(scene, method);
        }
        const double r = scene.setting.radius;
        effects.species = {{2, r, 3}, {4, 0.5 * r, 0.2}, {scene.discs.size() - 6, r, 1}};
        effects.boundaries[3].restitution = 0.7;
        check_bits(scene, Method::time_stepped);
        effects.gravity = {0.01, -0.03};
        effects.boundaries[1] = {BoundaryKind::moving, 1, 0, -0.03};
        check_bits(scene, Method::event_driven);
    }
}

TEST_CASE("effects: smooth discs are the plain dynamics to the bit, whatever their spins") {
    const Communicator world = Communicator::world();
    for (TestScene scene : base_scenes()) {
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            INFO(scene.name);
            scene.setting.effects = {};
            const StateHash plain = run(scene, method, world).hash;
            for (const ContactEffect& contact : {rough(1, -1, no_limit), rough(1, 0.5, 0)}) {
                scene.setting.effects.contact = contact;
                DiscSystem system = system_of(scene, method, world);
                advance_to(system, scene.steps);
                StateHash hash = hash_of(system.discs());
                std::array<std::uint64_t, 2> sums{hash.low, hash.high};
                world.sum(sums);
                CHECK(StateHash{sums[0], sums[1]} == plain);
                for (const double spin : system.spins()) CHECK(spin == 0);
            }
        }
    }
}

// Checks momentum, the angular momentum of each disc about the point of contact (where the impulse
// acts), both restitutions, and the energy that remains. With the reduced mass m and a = q / (1 +
// q) for moments of inertia q m r^2, the loss is m/2 ((1 - e^2) g_n^2 + a (1 - b^2) g_t^2) if
// surfaces stick.
TEST_CASE("effects: a collision of rough discs conserves what it must, and loses what its "
          "coefficients say") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        for (const ContactEffect& contact :
             {rough(0.8, 0.3, no_limit), rough(1, 1, no_limit), rough(0.5, -0.4, no_limit, 1),
              rough(0.9, 0.9, 0.02, 0.25)}) {
            const auto [before, after] = meet(contact, method, world);
            const long double ex = before[1].x - before[0].x, ey = before[1].y - before[0].y,
                              length = std::sqrt(ex * ex + ey * ey);
            CHECK(static_cast<double>(length) == Approx(4).epsilon(1e-13));
            const long double cx = before[0].x + ex * 3 / 4, cy = before[0].y + ey * 3 / 4;
            CHECK(
                static_cast<double>(5 * after[0].vx + 0.7L * after[1].vx) ==
                Approx(static_cast<double>(5 * before[0].vx + 0.7L * before[1].vx)).epsilon(1e-14));
            CHECK(
                static_cast<double>(5 * after[0].vy + 0.7L * after[1].vy) ==
                Approx(static_cast<double>(5 * before[0].vy + 0.7L * before[1].vy)).epsilon(1e-13));
            for (std::size_t k = 0; k < 2; ++k)
                CHECK(
                    static_cast<double>(after[k].angular_momentum(cx, cy)) ==
                    Approx(static_cast<double>(before[k].angular_momentum(cx, cy))).margin(1e-12));
            const auto [normal, slip] = surface_velocity(before);
            const auto [parting, left] = surface_velocity(after);
            CHECK(static_cast<double>(parting) ==
                  Approx(static_cast<double>(-contact.restitution * normal)).epsilon(1e-13));
            const long double reduced = 5 * 0.7L / 5.7L,
                              a = contact.inertia / (1 + contact.inertia);
            if (std::isinf(contact.friction)) {
                CHECK(static_cast<double>(left) ==
                      Approx(static_cast<double>(-contact.tangential_restitution * slip))
                          .epsilon(1e-12));
                const long double e = contact.restitution, b = contact.tangential_restitution;
                const long double lost = reduced / 2 *
                                         ((1 - e * e) * normal * normal +
                                          a * (1 - b * b) * slip * slip);
                CHECK(energy(before) - energy(after) ==
                      Approx(static_cast<double>(lost)).margin(1e-14 * energy(before)));
            } else { // if they slide, the tangential impulse is `friction` times the normal one
                const long double push = reduced * (1 + contact.restitution) * std::fabs(normal) *
                                         contact.friction;
                CHECK(static_cast<double>(std::fabs(slip - left)) ==
                      Approx(static_cast<double>(push / (reduced * a))).epsilon(1e-12));
                CHECK(static_cast<double>(left * slip) > 0);
                CHECK(energy(after) < energy(before));
            }
        }
    }
}

// A gas of perfectly rough discs conserves its energy and distributes it equally: kT / 2 for each
// of the three degrees of freedom of a disc.
TEST_CASE(
    "effects: a gas of perfectly rough discs keeps its energy, and a third of it goes to spins") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(400, 0.3, 0.3, 606);
    scene.setting.effects.contact = rough(1, 1, no_limit);
    DiscSystem system = system_of(scene, Method::event_driven, world);
    const double start = system.totals().kinetic_energy;
    advance_to(system, 600);
    constexpr int n_samples = 30;
    double share = 0;
    for (int sample = 0; sample < n_samples; ++sample) {
        advance_to(system, system.step() + 30);
        const Totals now = system.totals();
        CHECK(now.kinetic_energy + now.rotational_energy == Approx(start).epsilon(1e-12));
        share += now.rotational_energy / start / n_samples;
    }
    // Spins are N of the 3 N degrees of freedom. In one sample their share has an error of about
    // 2/3 sqrt(1 / (3 N)); samples are some ten collisions apart.
    CHECK(share == Approx(1.0 / 3).margin(4 * 2.0 / 3 / std::sqrt(3 * 400.0 * n_samples)));
    CHECK(system.totals().overlapping_pairs == 0);
}
