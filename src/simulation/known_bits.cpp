// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/known_bits.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/state_hash.hpp"
#include "core/stop_request.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/advance.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t lattice_side = 8;

const char* name_of(Method method) {
    return method == Method::time_stepped ? "time-stepped" : "event-driven";
}

/// The expected result of `hash_of`. Only a change of the method itself may change it.
const char* known_hash(Method method) {
    return method == Method::time_stepped ? "db7554744bbfab28cfc985786c4ad0dc"
                                          : "27f1b7fd3822c8519554c9040e1df5c3";
}

/// The state hash after a run of a square lattice of packing 0.4 with irregular velocities.
std::string hash_of(Method method) {
    SceneParameters scene;
    scene.box = {lattice_side, lattice_side};
    scene.radius = 0.36;
    scene.n_discs = lattice_side * lattice_side;
    scene.method = method;
    scene.steps = 20;
    scene.effects.gravity.y = -0.01;
    std::vector<InputDisc> discs;
    for (std::uint64_t id = 0; id < scene.n_discs; ++id) {
        const auto odd = [id](std::uint64_t factor, std::uint64_t n) {
            return (static_cast<double>(id * factor % n) + 0.5) / static_cast<double>(n) - 0.5;
        };
        discs.push_back({id, static_cast<double>(id % lattice_side) + 0.5,
                         static_cast<double>(id / lattice_side) + 0.5, 0.3 * odd(37, 101),
                         0.3 * odd(59, 103)});
    }
    DiscSystem system(scene, discs, Communicator::of_this_rank(), {});
    advance_to(system, scene.steps);
    return to_string(system.totals().hash);
}

/// Describes the first wrong hash on this rank; empty if there is none, or if a stop is requested
/// during the test, because the run then stops on all ranks together.
std::string difference_here() try {
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        const std::string hash = hash_of(method);
        if (hash != known_hash(method))
            return fmt::format("a known {} scene ends with the state hash {} instead of {}",
                               name_of(method), hash, known_hash(method));
    }
    return {};
} catch (const StopRequested&) {
    return {};
}

} // namespace

std::string warning_of_other_bits(const Communicator& ranks) {
    std::string difference = difference_here();
    const auto lowest = static_cast<int>(
        ranks.min(std::int64_t{difference.empty() ? ranks.size() : ranks.rank()}));
    if (lowest == ranks.size()) return {};
    ranks.broadcast(difference, lowest);
    return fmt::format("this build of Carrom computes other bits than its release: on rank {} {}; "
                       "build it without flags that change floating-point arithmetic "
                       "(-ffast-math, -Ofast, -funsafe-math-optimizations)",
                       lowest, difference);
}

} // namespace carrom
