// SPDX-License-Identifier: BSD-3-Clause
// A disc that bounces at an oscillating wall, from sync to sync, compared with the wall's position
// in long double.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "catch.hpp"

#include "dynamics/all_dynamics.hpp"
#include "numbers_of_any_size.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

using Long = long double;
constexpr Long two_pi = 2 * std::numbers::pi_v<Long>;

/// A disc that bounces at one wall of a box of 40, from sync to sync.
struct Bouncer {
    Effects effects;
    std::size_t side = 0;
    double sync = 64;
    DiscState disc;

    bool is_x() const { return side < 2; }
    double sign() const { return side % 2 == 0 ? 1 : -1; }
    Long gap(Long begin, double time) const {
        const Boundary& wall = effects.boundaries[side];
        const Long pull = is_x() ? effects.gravity.x : effects.gravity.y;
        const Long place = is_x() ? disc.x : disc.y, speed = is_x() ? disc.vx : disc.vy;
        const Long at = place + speed * (Long(time) - disc.tau) + pull / 2 * Long(time) * time;
        const Long turns = std::fmod(begin + time, Long(wall.period)) / wall.period;
        const Long line = side % 2 == 0 ? 1 : 39;
        return sign() * (at - line - wall.amplitude * std::sin(two_pi * turns + wall.phase));
    }
    double largest_speed() const {
        const Boundary& wall = effects.boundaries[side];
        return 2 * std::numbers::pi * wall.amplitude / wall.period + std::fabs(disc.vx) +
               std::fabs(disc.vy);
    }
};

/// The disc lies on the wall, falls to it or arrives fast; the wall hardly moves or throws the disc
/// far.
Bouncer random_bouncer(Numbers& random) {
    Bouncer bouncer;
    bouncer.side = static_cast<std::size_t>(random.index(4));
    const double amplitude = random.of_any_size(1e-3, 3), period = random.of_any_size(0.05, 300),
                 phase = random.uniform(-6, 6), rate = 2 * std::numbers::pi / period,
                 sign = bouncer.sign();
    const double restitution = std::array{0.0, 0.3, 0.9,
                                          1.0}[static_cast<std::size_t>(random.index(4))];
    bouncer.effects.boundaries[bouncer.side] = {
        BoundaryKind::oscillating, restitution, 0, 0, amplitude, period, phase};
    double gravity = std::min(0.2, amplitude * rate * rate * random.of_any_size(0.01, 100));
    if (random.index(5) == 0) gravity = 0;
    if (0.5 * gravity * 64 * 64 > 20)
        bouncer.sync = std::max(1.0, std::floor(std::sqrt(40 / gravity)));
    Acceleration& pull = bouncer.effects.gravity;
    (bouncer.is_x() ? pull.x : pull.y) = (random.index(8) == 0 ? 1 : -1) * sign * gravity;
    bouncer.effects.contact.contact_time = random.of_any_size(0.01, 0.125) *
                                           std::min(period, 2 * bouncer.sync);
    const double above = random.index(3) == 0 ? 0 : random.of_any_size(1e-6, 10);
    const double height = 1 + sign * amplitude * std::sin(phase) + above;
    const double speed = random.index(4) == 0 ? sign * amplitude * rate * std::cos(phase)
                                              : random.uniform(-2, 2) * amplitude * rate;
    bouncer.disc.x = bouncer.disc.y = 20;
    (bouncer.is_x() ? bouncer.disc.x : bouncer.disc.y) = sign > 0 ? height : 40 - height;
    (bouncer.is_x() ? bouncer.disc.vx : bouncer.disc.vy) = sign * speed;
    return bouncer;
}

} // namespace

// Tests the time between contacts, too, and several sync intervals. The number of bounces must be
// bounded.
TEST_CASE("oscillation: a disc that bounces is never beyond the wall") {
    Numbers random(75);
    std::uint64_t n_all = 0;
    for (int k = 0; k < 150; ++k) {
        Bouncer bouncer = random_bouncer(random);
        DiscState& disc = bouncer.disc;
        WalledDynamics dynamics(40, 1, bouncer.effects);
        Long deepest = 0;
        double begin = 0, fastest = 0;
        std::uint64_t n = 0, most = 0;
        for (; begin < 10 * bouncer.sync; begin += bouncer.sync) {
            dynamics.begin_interval(static_cast<std::int64_t>(begin));
            most += 5000 + static_cast<std::uint64_t>(4 * bouncer.sync /
                                                      bouncer.effects.contact.contact_time);
            for (double last = 0; last < bouncer.sync && n < most;) {
                const Axis axis = bouncer.is_x() ? Axis::x : Axis::y;
                const double time = dynamics.wall_time(disc, axis);
                REQUIRE(time >= last);
                const double end = std::min(time, bouncer.sync);
                for (int i = 0; i <= 50; ++i)
                    deepest = std::max(deepest, -bouncer.gap(begin, last + (end - last) * i / 50));
                fastest = std::max(fastest, bouncer.largest_speed());
                last = end;
                if (!(time <= bouncer.sync)) break;
                CHECK(dynamics.may_meet_wall(disc, bouncer.sync));
                dynamics.bounce(disc, axis, time);
                ++n;
            }
            PlainDynamics::advance(disc, bouncer.sync);
            dynamics.restart_frame(disc, bouncer.sync);
            disc.tau = 0;
        }
        INFO("restitution " << bouncer.effects.contact.restitution << ", contact time "
                            << bouncer.effects.contact.contact_time);
        CHECK(n < most);
        CHECK(deepest < 0x1p-46 * 40 + fastest * bouncer.sync * 0x1p-50);
        n_all += n;
    }
    CHECK(n_all > 10000);
}
