// SPDX-License-Identifier: BSD-3-Clause
#include "periodic_bits.hpp"

#include <cstdint>
#include <optional>

#include <omp.h>

#include "catch.hpp"
#include "core/state_hash.hpp"
#include "effect_runs.hpp"
#include "event_driven.hpp"
#include "shape_parts.hpp"
#include "time_stepped.hpp"

namespace carrom::test {

namespace {

struct Expected {
    StateHash hash;
    std::uint64_t rejected = 0;
};

Expected expected_of(const TestScene& scene, Method method, const Communicator& world) {
    Expected expected;
    const auto add_states_of = [&expected](const auto& reference) {
        expected.hash = hash_of(reference.discs());
        for (DiscId id = 0; id < reference.spins().size(); ++id)
            expected.hash += hash_of(SideColumn::spin, id, reference.spins()[id]);
    };
    if (world.is_root() && method == Method::time_stepped) {
        reference::TimeSteppedReference reference(scene.setting, scene.discs);
        reference.run_steps(scene.steps);
        add_states_of(reference);
        expected.rejected = reference.counters().rejected_candidates;
    } else if (world.is_root()) {
        reference::EventDrivenReference reference(scene.setting, scene.discs);
        reference.run_steps(scene.steps);
        add_states_of(reference);
    }
    world.broadcast(expected);
    return expected;
}

} // namespace

void check_bits(const TestScene& scene, Method method) {
    const Communicator world = Communicator::world();
    static std::size_t n_runs = 0;
    if (is_left_to_others(n_runs++, n_sharing(world.size() * omp_get_max_threads()))) return;
    const Expected expected = expected_of(scene, method, world);
    INFO(scene.name << (method == Method::time_stepped ? ", time-stepped" : ", event-driven"));
    for (const std::optional<double>& window : {std::optional<double>{}, {0.3}, {2.7}}) {
        Tuning tuning;
        tuning.window = window;
        tuning.rebalance_above = window ? 0 : 1.05;
        if (window) tuning.ranks_across = *window < 1 ? 2 : 3;
        if (window) tuning.cell_width = 0.7;
        const Totals totals = run(scene, method, world, tuning);
        CHECK(to_string(totals.hash) == to_string(expected.hash));
        CHECK(totals.rejected_candidates == expected.rejected);
    }
    CHECK(to_string(run_with_restart(scene, method, world).hash) == to_string(expected.hash));
}

} // namespace carrom::test
