// SPDX-License-Identifier: BSD-3-Clause
// The memory check includes the extra bytes a disc where discs are clustered.
#include "catch.hpp"

#include "core/errors.hpp"
#include "machine/machine.hpp"
#include "run/memory_check.hpp"

using namespace carrom;

TEST_CASE("a scene that would just fit is refused where discs crowd") {
    const Communicator world = Communicator::world();
    const auto available = static_cast<double>(world.min(memory_per_rank(world))) * world.size();
    // Between the bytes a disc in a homogeneous gas, at most 110, and those with 48 more for
    // clustered discs.
    constexpr double bytes_between = 130;
    SceneParameters scene;
    for (const Method method : {Method::event_driven, Method::time_stepped}) {
        scene.method = method;
        scene.n_discs = static_cast<std::uint64_t>(available / bytes_between);
        CHECK_NOTHROW(check_memory(scene, world, 0));
        CHECK_THROWS_AS(check_memory(scene, world, 48), InputError);
    }
}
