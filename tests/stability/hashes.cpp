// SPDX-License-Identifier: BSD-3-Clause
// Prints one fingerprint of many runs of both methods, on which every compiler and instruction set
// must agree.
//
// With an argument it uses only scenes whose name contains it, and prints a line for each run, so
// that the first difference can be found.
#include <algorithm>
#include <cstdio>
#include <exception>

#include "core/errors.hpp"
#include "event_driven.hpp"
#include "parallel/communicator.hpp"
#include "parallel/mpi.hpp"
#include "runs.hpp"
#include "scene_tools.hpp"
#include "troubled_effects.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

std::string text_of(const TestScene& scene, Method method) {
    try {
        return to_string(run(scene, method).totals.hash);
    } catch (const InputError&) {
        return "refused";
    }
}

/// Hundreds of discs on one line that fly hundreds of diameters a step: millions of collisions that
/// test nothing else.
bool is_long_under_all(const TestScene& scene) {
    const bool is_line = scene.name.rfind("chain", 0) == 0 || scene.name.rfind("cradle", 0) == 0;
    return scene.cascades_when_event_driven || (is_line && scene.discs.size() >= 400);
}

/// A gas, a dense group or a break shot, with random effects.
TestScene scene_with_effects(std::uint64_t seed, Method method) {
    TestScene scene = seed % 3 == 0   ? gas(60, 0.3, 0.5, 900 + seed)
                      : seed % 3 == 1 ? gas(64, 0.6, 0.1, 900 + seed)
                                      : break_shot(5, 0.5, 3, 0.1);
    scene.steps = 10;
    scene.setting.sync_every = seed % 2 == 0 ? 3 : 64;
    scene.setting.micro_steps = seed % 4 == 0 ? 2 : 1;
    return with_effects(scene, method, seed);
}

/// Adds a line to the FNV-1a hash.
void add(std::uint64_t& sum, const std::string& line) {
    for (const char c : line) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
}

} // namespace

int main(int argc, char** argv) {
    Mpi mpi(argc, argv);
    return run_on_all(Communicator::world(), [&](const Communicator& world) {
        std::uint64_t sum = 0xcbf29ce484222325u;
        std::size_t n_runs = 0;
        std::vector<TestScene> scenes = small_scenes();
        for (TestScene& scene : large_scenes()) {
            scene.steps = 2;
            scenes.push_back(scene);
        }
        const auto add_run = [&](const TestScene& scene, Method method) {
            const std::string line = text_of(scene, method) + "  " + name_of(method) + "  " +
                                     scene.name;
            add(sum, line);
            ++n_runs;
            if (argc > 1 && world.is_root()) std::printf("%s\n", line.c_str());
        };
        const auto is_asked_for = [&](const TestScene& scene) {
            return argc < 2 || scene.name.find(argv[1]) != std::string::npos;
        };
        for (TestScene& scene : scenes) {
            if (!is_asked_for(scene)) continue;
            for (const Method method : {Method::time_stepped, Method::event_driven}) {
                if (method == Method::event_driven && is_long_under_all(scene)) continue;
                if (method == Method::event_driven)
                    scene.steps = std::min<std::int64_t>(scene.steps, 4);
                add_run(scene, method);
            }
        }
        for (std::uint64_t seed = 1; seed <= 40; ++seed) {
            for (const Method method : {Method::time_stepped, Method::event_driven}) {
                const TestScene scene = scene_with_effects(seed, method);
                if (is_asked_for(scene)) add_run(scene, method);
            }
        }
        if (world.is_root())
            std::printf("%016llx %zu runs\n", static_cast<unsigned long long>(sum), n_runs);
        return 0;
    });
}
