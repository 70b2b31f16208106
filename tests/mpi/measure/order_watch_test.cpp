// SPDX-License-Identifier: BSD-3-Clause
// The watched order is psi6 at the watch's own steps. The order does not depend on ranks, and
// continues after a restart.
#include <cmath>
#include <optional>
#include <vector>

#include "catch.hpp"

#include "measure/order_watch.hpp"
#include "measured_runs.hpp"
#include "simulation/disc_order.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr std::int64_t last_step = 150;

/// Dense discs between walls under gravity, so that energies are watched as well.
TestScene dense_discs() {
    TestScene test = gas(100, 0.68, 2, 5);
    test.setting.effects.gravity = {0, -0.01};
    test.steps = last_step;
    return test;
}

SceneParameters scene_with_steps(const TestScene& test) {
    SceneParameters scene = scene_of(test);
    scene.method = Method::event_driven;
    scene.steps = last_step;
    return scene;
}

void advance(DiscSystem& system, OrderWatch& watch, std::int64_t step,
             std::vector<double>* psi6 = nullptr) {
    while (system.step() < step) {
        const std::int64_t due = watch.next_due(system.step());
        system.advance_towards(std::min(step, due));
        if (psi6 && system.step() == due) {
            const HexaticSums sums = hexatic_order(system, 2 * system.averaged_system().radius, 1);
            psi6->push_back(std::hypot(sums.real.value(), sums.imaginary.value()) / 100);
        }
        watch.act();
    }
}

} // namespace

TEST_CASE("measurements: the watched order is the psi6 of all discs at steps of its own") {
    const Communicator world = Communicator::world();
    const TestScene test = dense_discs();
    const SceneParameters scene = scene_with_steps(test);
    REQUIRE(scene.packing() > OrderWatch::least_watched_packing);
    DiscSystem system = system_of(scene, test, world);
    OrderWatch watch(scene, system, world);
    watch.begin();
    CHECK(watch.watched().empty());
    std::vector<double> psi6;
    advance(system, watch, last_step, &psi6);
    REQUIRE(psi6.size() >= 8);
    double mean = 0;
    for (const double one : psi6) mean += one / static_cast<double>(psi6.size());
    const std::vector<WatchedNumber> watched = watch.watched();
    REQUIRE(watched.size() >= 2);
    CHECK(watched[0].name == "psi6");
    CHECK(watched[0].mean.value == Approx(mean).epsilon(1e-12));
    // moduli are at least the modulus of the mean
    CHECK(watched[1].mean.value > watched[0].mean.value);
    const std::array<double, 4> quarters = quarters_of(psi6);
    for (std::size_t k = 0; k < quarters.size(); ++k)
        CHECK(watched[0].quarters[k] == Approx(quarters[k]).epsilon(1e-12));
}

TEST_CASE("measurements: a watch goes on after a restart") {
    const Communicator world = Communicator::world();
    const TestScene test = dense_discs();
    const SceneParameters scene = scene_with_steps(test);
    DiscSystem whole = system_of(scene, test, world);
    OrderWatch expected(scene, whole, world);
    expected.begin();
    advance(whole, expected, last_step);

    DiscSystem first = system_of(scene, test, world);
    OrderWatch stopped(scene, first, world);
    stopped.begin();
    advance(first, stopped, 61);
    StoredState state = {{first.discs().begin(), first.discs().end()},
                         first.micro_steps_done(),
                         SideColumns(first.side_columns())};
    DiscSystem second(scene, std::move(state), world, {});
    OrderWatch watch(scene, second, world);
    watch.begin(stopped.stored());
    advance(second, watch, last_step);
    CHECK(watch.stored() == expected.stored());
    CHECK(to_string(second.totals().hash) == to_string(whole.totals().hash));

    std::vector<std::int64_t> damaged = stopped.stored();
    damaged.pop_back();
    OrderWatch anew(scene, second, world);
    anew.begin(damaged);
    CHECK(anew.watched().empty());
}

TEST_CASE("measurements: the order of some discs is that of each of them") {
    const Communicator world = Communicator::world();
    const TestScene test = dense_discs();
    DiscSystem system = system_of(scene_with_steps(test), test, world);
    const HexaticSums sums = sampled_order(system, 33); // uses every fourth id
    const std::vector<BondOrder> orders = bond_orders(system);
    ExactSum real(200), modulus(200);
    for (std::size_t k = 0; k < orders.size(); ++k) {
        if (system.discs()[k].id % 4 != 0) continue;
        real.add(orders[k].real);
        modulus.add(
            std::sqrt(orders[k].real * orders[k].real + orders[k].imaginary * orders[k].imaginary));
    }
    world.sum(real), world.sum(modulus);
    CHECK(sums.real.value() == real.value());
    CHECK(sums.modulus.value() == modulus.value());
    std::uint64_t n = 0;
    for (const std::uint64_t one : sums.neighbours) n += one;
    CHECK(n == 25);
}

TEST_CASE("measurements: dilute discs are not watched") {
    const Communicator world = Communicator::world();
    TestScene test = gas(100, 0.3, 0.05, 5);
    const SceneParameters scene = scene_with_steps(test);
    DiscSystem system = system_of(scene, test, world);
    OrderWatch watch(scene, system, world);
    watch.begin();
    CHECK(watch.next_due(0) > scene.steps);
    CHECK(watch.stored().empty());
}

TEST_CASE("measurements: quarters are means of parts of equal length, or nothing") {
    const std::vector<double> terms = {1, 3, 5, 7, 2, 2, 8, 10};
    CHECK(quarters_of(terms) == std::array<double, 4>{2, 6, 2, 9});
    CHECK(std::isnan(quarters_of(std::span(terms).first(7))[0]));
}
