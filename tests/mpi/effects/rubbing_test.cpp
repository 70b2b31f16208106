// SPDX-License-Identifier: BSD-3-Clause
// Walls and obstacles with friction and sliding surfaces: collisions and rolling by the laws of
// mechanics, the same bits on every machine shape, and the self-check.
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "catch.hpp"

#include "effect_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();
constexpr Boundary periodic{BoundaryKind::periodic, 1, 0, 0};

ContactEffect rough(double inertia) {
    return {ContactKind::rough, 0.9, 0.001, 0.3, no_limit, inertia};
}

struct Motion {
    double vx = 0, vy = 0, spin = 0;
};

/// The motion of the scene's only disc, which starts with the spin `spin`. **Collective.**
Motion motion_after(const TestScene& scene, double spin, Method method, const Communicator& world,
                    std::uint64_t n_bounces) {
    SceneParameters all = scene_of(scene);
    all.method = method;
    StoredState state;
    const bool turns = scene.setting.effects.contact.kind == ContactKind::rough;
    if (world.is_root()) {
        const InputDisc& disc = scene.discs[0];
        state.discs.push_back({disc.x, disc.y, disc.vx, disc.vy, 0, 0, 0, 0});
        if (turns) state.columns.add(SideColumn::spin, {spin});
    }
    DiscSystem system(all, state, world, {});
    advance_to(system, scene.steps);
    if (n_bounces > 0) CHECK(system.totals().wall_collisions == n_bounces);
    Motion mine;
    for (const DiscState& disc : system.shown()) {
        mine.vx = disc.vx;
        mine.vy = disc.vy;
        if (turns) mine.spin = system.spins()[0];
    }
    Motion sum;
    for (const Motion& part : world.all_gather(mine)) {
        sum.vx += part.vx;
        sum.vy += part.vy;
        sum.spin += part.spin;
    }
    return sum;
}

/// A body with an outward normal (nx, ny), whose surface moves with velocity u along (-ny, nx).
struct Body {
    double nx, ny, u;
};

/// The velocity along t = (-ny, nx) of the surface of a disc of radius 2 relative to the body's
/// surface.
double slip(const Motion& disc, const Body& body) {
    return disc.vy * body.nx - disc.vx * body.ny - body.u - 2 * disc.spin;
}

double normal_of(const Motion& disc, const Body& body) {
    return disc.vx * body.nx + disc.vy * body.ny;
}

/// The impulse acts where the surfaces touch. So the change of angular momentum about the centre is
/// -r times the change of momentum along t.
void check_blow(const Motion& before, const Motion& after, const Body& body, const Surface& surface,
                const ContactEffect& contact) {
    const double along = (after.vy - before.vy) * body.nx - (after.vx - before.vx) * body.ny;
    const double pushed = normal_of(after, body) - normal_of(before, body);
    CHECK(pushed > 0);
    if (contact.kind == ContactKind::rough)
        CHECK(contact.inertia * 4 * (after.spin - before.spin) == Approx(-2 * along).margin(1e-12));
    const double h = slip(before, body), most = surface.friction * pushed;
    if (std::fabs(along) < most * (1 - 1e-9))
        CHECK(slip(after, body) == Approx(-surface.tangential_restitution * h).margin(1e-12));
    else
        CHECK(along == Approx(h > 0 ? -most : most).epsilon(1e-12));
}

/// A disc of radius 2 that flies from the middle of the box to the side.
TestScene towards(std::size_t side, const Surface& surface, const ContactEffect& contact) {
    TestScene scene = empty_scene("to a wall", 64, 2, 50);
    constexpr std::array vx{-1.0, 1.0, 0.125, 0.125}, vy{0.125, 0.125, -1.0, 1.0};
    add_disc(scene, 32, 32, vx[side], vy[side]);
    scene.setting.effects.contact = contact;
    scene.setting.effects.boundaries[side].surface = surface;
    scene.setting.effects.boundaries[side].restitution = 0.75;
    return scene;
}

constexpr std::array<std::array<double, 2>, 4> normals{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

std::vector<Surface> surfaces() {
    return {{0.5, no_limit, 0}, {0, no_limit, 0.3}, {1, no_limit, -0.2}, {0.2, 0.05, 0.7}};
}

} // namespace

TEST_CASE("effects: a wall that rubs acts on velocity and spin as mechanics says") {
    const Communicator world = Communicator::world();
    for (const ContactEffect& contact : {ContactEffect{}, rough(0.5)}) {
        for (const Surface& surface : surfaces()) {
            for (std::size_t side = 0; side < 4; ++side) {
                for (const Method method : {Method::time_stepped, Method::event_driven}) {
                    INFO("side " << side << ", e_t " << surface.tangential_restitution
                                 << ", contact " << static_cast<int>(contact.kind));
                    const TestScene scene = towards(side, surface, contact);
                    const bool turns = contact.kind == ContactKind::rough;
                    const Motion before{scene.discs[0].vx, scene.discs[0].vy, turns ? 0.15 : 0};
                    const Motion after = motion_after(scene, before.spin, method, world, 1);
                    const auto [nx, ny] = normals[side];
                    // The velocity of a side is along +x or +y, which is the direction of t or the
                    // opposite one.
                    const Body body{nx, ny, surface.velocity * (nx - ny)};
                    CHECK(normal_of(after, body) == Approx(0.75).epsilon(1e-12));
                    check_blow(before, after, body, surface, contact);
                }
            }
        }
    }
}

TEST_CASE("effects: obstacles that rub act on velocity and spin as mechanics says") {
    const Communicator world = Communicator::world();
    for (const ContactEffect& contact : {ContactEffect{}, rough(0.5)}) {
        for (const Surface& surface : surfaces()) {
            for (const bool is_segment : {false, true}) {
                for (const Method method : {Method::time_stepped, Method::event_driven}) {
                    TestScene scene = empty_scene("to an obstacle", 64, 2, 30);
                    add_disc(scene, 16, 32, 1, 0.125);
                    FixedBodyList& obstacles = scene.setting.effects.fixed_bodies;
                    obstacles.restitution = 0.75;
                    obstacles.surface = surface;
                    if (is_segment)
                        obstacles.segments = {{40, 20, 44, 60}};
                    else
                        obstacles.discs = {{40, 30, 5}};
                    scene.setting.effects.contact = contact;
                    const bool turns = contact.kind == ContactKind::rough;
                    const Motion before{1, 0.125, turns ? -0.2 : 0};
                    const Motion after = motion_after(scene, before.spin, method, world, 1);
                    // The line of centres when surfaces touch; for the segment its normal.
                    double nx = -40 / std::hypot(4, 40), ny = 4 / std::hypot(4, 40);
                    if (!is_segment) {
                        const double dx = 16 - 40, dy = 32 - 30, b = dx + 0.125 * dy,
                                     a = 1 + 0.125 * 0.125, c = dx * dx + dy * dy - 49;
                        const double time = (-b - std::sqrt(b * b - a * c)) / a;
                        nx = (dx + time) / 7;
                        ny = (dy + 0.125 * time) / 7;
                    }
                    const Body body{nx, ny, surface.velocity};
                    CHECK(normal_of(after, body) ==
                          Approx(-0.75 * normal_of(before, body)).epsilon(1e-12));
                    check_blow(before, after, body, surface, contact);
                }
            }
        }
    }
}

// A disc that lies on a floor while gravity also pulls it to the right. If mu g_y >= g_x q / (1 +
// q), friction makes it roll with the acceleration g_x / (1 + q). Otherwise it slides with g_x - mu
// g_y, and turns with mu g_y / (q r). The floor acts once in a contact time of 1/16.
TEST_CASE(
    "effects: a rough disc that is pulled along a floor rolls, or slides, as mechanics says") {
    const Communicator world = Communicator::world();
    const double pull = 0.0009, down = 0.01, time = 200, radius = 2;
    for (const double inertia : {0.5, 1.0}) {
        for (const double friction : {0.1, 0.02}) {
            TestScene scene = empty_scene("a disc on a floor", 64, radius, 200);
            add_disc(scene, 32, radius, 0, 0);
            Effects& effects = scene.setting.effects;
            effects.boundaries = {periodic, periodic, Boundary{}, Boundary{}};
            effects.boundaries[2].restitution = 0;
            effects.boundaries[2].surface = {0, friction, 0};
            effects.contact = rough(inertia);
            effects.contact.contact_time = 0.0625;
            effects.gravity = {pull, -down};
            scene.setting.sync_every = 16;
            const Motion motion = motion_after(scene, 0, Method::event_driven, world, 0);
            const bool rolls = friction * down >= pull * inertia / (1 + inertia);
            INFO("friction " << friction << ", inertia " << inertia << ", rolls " << rolls);
            const double vx = time * (rolls ? pull / (1 + inertia) : pull - friction * down);
            const double surface = time *
                                   (rolls ? pull / (1 + inertia) : friction * down / inertia);
            CHECK(motion.vx == Approx(vx).epsilon(0.002));
            CHECK(-motion.spin * radius == Approx(surface).epsilon(0.002));
        }
    }
}

TEST_CASE("effects: walls that rub and slide give the same bits on every shape, and are checked") {
    const Communicator world = Communicator::world();
    for (const int kind : {0, 1, 2, 3}) {
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            TestScene scene = gas(200, 0.2, 0.1, 660 + static_cast<std::uint64_t>(kind));
            INFO("kind " << kind << ", method " << static_cast<int>(method));
            scene.setting.sync_every = 6;
            scene.setting.micro_steps = 2;
            scene.steps = 40;
            Effects& effects = scene.setting.effects;
            effects.contact = kind % 2 == 0 ? ContactEffect{ContactKind::restitution, 0.8, 0.001}
                                            : rough(0.5);
            effects.boundaries[0].surface = {0.5, no_limit, 0.05};
            effects.boundaries[2].surface = {0, 0.3, -0.05};
            effects.boundaries[3].surface = {1, no_limit, 0};
            if (kind == 2) {
                effects.boundaries[3] = {BoundaryKind::thermal, 1, 0.01};
                effects.boundaries[3].surface.velocity = 0.1;
            }
            if (kind >= 2) {
                effects.boundaries[0] = effects.boundaries[1] = periodic;
                if (method == Method::event_driven) effects.gravity = {0.002, -0.001};
            } else {
                effects.fixed_bodies.segments = {{20, 20, 30, 24}};
                effects.fixed_bodies.surface = {0, 0.5, 0.1};
                make_room_for_obstacles(scene);
            }
            check_shared_run(scene, method, world);
        }
    }
}
