// SPDX-License-Identifier: BSD-3-Clause
#include "reference_bits.hpp"

#include <optional>

#include <omp.h>

#include "catch.hpp"

#include "core/state_hash.hpp"
#include "event_driven.hpp"
#include "shape_parts.hpp"
#include "time_stepped.hpp"

namespace carrom::test {

namespace {

template <class Reference>
StateHash reference_hash(const TestScene& scene, const Communicator& world) {
    StateHash hash;
    if (world.is_root()) {
        Reference reference(scene.setting, scene.discs);
        reference.run_steps(scene.steps);
        hash = hash_of(reference.discs());
        for (DiscId id = 0; id < reference.spins().size(); ++id)
            hash += hash_of(SideColumn::spin, id, reference.spins()[id]);
    }
    world.broadcast(hash);
    return hash;
}

} // namespace

void check_bits(const TestScene& scene, Method method) {
    const Communicator world = Communicator::world();
    static std::size_t n_runs = 0;
    if (is_left_to_others(n_runs++, n_sharing(world.size() * omp_get_max_threads()))) return;
    const StateHash expected = method == Method::time_stepped
                                   ? reference_hash<reference::TimeSteppedReference>(scene, world)
                                   : reference_hash<reference::EventDrivenReference>(scene, world);
    INFO(scene.name << (method == Method::time_stepped ? ", time-stepped" : ", event-driven"));
    for (const std::optional<double>& window : {std::optional<double>{}, {0.3}, {2.7}}) {
        Tuning tuning;
        tuning.window = window;
        tuning.rebalance_above = window ? 0 : 1.05;
        if (window) tuning.ranks_across = *window < 1 ? 2 : 3;
        CHECK(to_string(run(scene, method, world, tuning).hash) == to_string(expected));
    }
    CHECK(to_string(run_with_restart(scene, method, world).hash) == to_string(expected));
}

std::vector<TestScene> base_scenes() {
    std::vector<TestScene> scenes{gas(300, 0.05, 0.8, 501), gas(196, 0.6, 0.3, 502),
                                  break_shot(5, 0.5, 3, 0.1), cradle(12, 0.5, 0.25, 1)};
    for (TestScene& scene : scenes) {
        scene.steps = 14;
        scene.setting.sync_every = 5;
        scene.setting.micro_steps = 2;
    }
    return scenes;
}

} // namespace carrom::test
