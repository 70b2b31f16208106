// SPDX-License-Identifier: BSD-3-Clause
// Collision cascades in precisions and formulas in which rounding may keep discs from moving.
#include "catch.hpp"

#include <string>

#include "core/errors.hpp"
#include "run/pilot/trial.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;

namespace {

/// A disc that flies to and fro between two walls, 2^20 times in a step. All its numbers are sums
/// of few powers of two, also in single precision, so the number of its collisions is known.
constexpr double room = 0x1p-20;
constexpr std::uint64_t n_bounces = 1 << 20;

SceneParameters narrow_room() {
    SceneParameters scene = read_scene(
        "[box]\nsize = 3\n[discs]\nradius = 1\nlist = [[1, 1, 1, 0]]\n[time]\nsteps = 1\n",
        "narrow.toml");
    scene.box = 2 + room;
    return scene;
}

/// The message with which the run ends early; empty if it does not.
std::string end_of(const RunSetting& setting, const Communicator& world, Totals& totals) {
    const SceneParameters scene = with_setting(narrow_room(), setting);
    try {
        DiscSystem system(scene, scene.listed_discs, world, {});
        advance_to(system, 1);
        totals = system.totals();
    } catch (const CollectiveError& error) {
        CHECK(error.code() == ExitCode::collective_failure);
        return error.what();
    }
    return {};
}

} // namespace

TEST_CASE("collisions at a rounding of time from each other have no end where settings cannot "
          "tell, and are told of") {
    const Communicator world = Communicator::world();
    Totals totals;
    CHECK(end_of({Method::event_driven}, world, totals) == "");
    CHECK(totals.wall_collisions == n_bounces);
    for (const Precision precision : {Precision::double_, Precision::single}) {
        for (const Arithmetic arithmetic : {Arithmetic::stable, Arithmetic::naive}) {
            if (precision == Precision::double_ && arithmetic == Arithmetic::stable) continue;
            const std::string text = end_of({Method::event_driven, 1, precision, arithmetic}, world,
                                            totals);
            INFO(text);
            CHECK(text.starts_with("disc 0 collides without end at step 0."));
            CHECK(text.find("the scene's precision and arithmetic do not tell when it moves") !=
                  std::string::npos);
        }
    }
    // The time-stepped method always ends, because a disc collides at most once a micro-step.
    CHECK(end_of({Method::time_stepped, 1, Precision::single, Arithmetic::naive}, world, totals) ==
          "");
    CHECK(totals.wall_collisions == 1);
}
