// SPDX-License-Identifier: BSD-3-Clause
// `time.accuracy` reaches the required accuracy in scenes for which it was not tuned.
#include "catch.hpp"

#include <algorithm>
#include <cmath>

#include "core/errors.hpp"
#include "initial_state/initial_state.hpp"
#include "run/pilot/setting_choice.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;

namespace {

SceneParameters unknown_gas(const std::string& more) {
    return read_scene("[box]\nsize = 50\n[time]\nsteps = 10\n[discs]\n" + more, "gas.toml");
}

/// Tests the errors of a chosen setting in several starts that the pilot did not use.
void check_delivery(SceneParameters scene, double accuracy, const Communicator& world,
                    int n_starts = 3, double pairs = 1e5) {
    scene.accuracy = accuracy;
    choose_setting(scene, initial_state(scene, nullptr, world), Messages(), world, {});
    CHECK_FALSE(scene.accuracy);
    const RunSetting setting{scene.method, scene.micro_steps};
    CAPTURE(scene.n_discs, scene.packing(), accuracy, setting.micro_steps,
            setting.method == Method::event_driven);
    double frequency = 0, pressure = 0, error = 0;
    for (int start = 0; start < n_starts; ++start) {
        SceneParameters other = scene;
        other.seed = 900 + static_cast<std::uint64_t>(start);
        const TrialStart begin = bring_to_equilibrium(other, initial_state(other, nullptr, world),
                                                      10, world, {});
        TrialLength length;
        length.steps = std::max<std::int64_t>(
            1, std::llround(pairs / (begin.frequency * static_cast<double>(scene.n_discs) / 2)));
        const TrialError here = error_of(
            run_trial(other, setting, begin, length, world, {}),
            run_trial(other, {Method::event_driven}, begin, length, world, {}));
        frequency += here.frequency / n_starts;
        pressure += here.pressure / n_starts;
        error += here.error / n_starts;
    }
    error /= std::sqrt(n_starts);
    CHECK(std::fabs(frequency) < accuracy + 4 * error);
    CHECK(std::fabs(pressure) < accuracy + 4 * error);
}

} // namespace

TEST_CASE("an accuracy is delivered on three scenes that the choice was not made for") {
    const Communicator world = Communicator::world();
    check_delivery(
        unknown_gas("count = 300\npacking = 0.05\nspeed = 0.3\nvelocities = 'uniform'\nseed = 5\n"),
        0.1, world);
    check_delivery(
        unknown_gas("count = 1000\npacking = 0.4\nspeed = 0.02\ngenerator = 'lattice'\n"), 0.05,
        world);
    check_delivery(unknown_gas("count = 600\npacking = 0.2\nspeed = 0.9\n[[discs.streams]]\nregion "
                               "= [0, 0, 25, 50]\nvelocity = [0.2, 0]\n"),
                   0.3, world);
}

TEST_CASE("an accuracy is delivered where errors are small at first and grow for hundreds of "
          "collisions") {
    const Communicator world = Communicator::world();
    check_delivery(
        unknown_gas("count = 16384\npacking = 0.7\nspeed = 0.006\ngenerator = 'lattice'\n"), 0.1,
        world, 1, 60 * 16384 / 2.0);
}

TEST_CASE("what no pilot can see is left to the event-driven method, and the choice is written "
          "over the question") {
    const Communicator world = Communicator::world();
    SceneParameters scene = unknown_gas("count = 300\npacking = 0.1\nspeed = 0.3\n");
    scene.overrides = {"time.accuracy=1e-6", "time.steps=9"};
    scene.accuracy = 1e-6;
    choose_setting(scene, initial_state(scene, nullptr, world), Messages(), world, {});
    CHECK(scene.method == Method::event_driven);
    CHECK(scene.overrides == std::vector<std::string>{"time.steps=9", "time.method=event-driven",
                                                      "time.micro_steps=1"});
    const SceneParameters again = read_scene({"gas.toml",
                                              "[box]\nsize = 50\n[discs]\ncount = 300\npacking = "
                                              "0.1\n[time]\nsteps = 1\naccuracy = 0.1\n",
                                              0, false},
                                             scene.overrides);
    CHECK((again.method == Method::event_driven && !again.accuracy && again.steps == 9));
}

TEST_CASE("discs that never meet have no error to choose by") {
    const Communicator world = Communicator::world();
    SceneParameters scene = read_scene(
        "[box]\nsize = 9\n[discs]\nradius = 1\nlist = [[2, 2, 0, 1], [5, 2, "
        "0, 1]]\n[time]\nsteps = 5\naccuracy = 0.1\n",
        "two.toml");
    CHECK_THROWS_AS(choose_setting(scene, scene.listed_discs, Messages(), world, {}), InputError);
}
