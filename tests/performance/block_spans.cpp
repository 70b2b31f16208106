// SPDX-License-Identifier: BSD-3-Clause
// How well threads would share the blocks of the event-driven method, counted and not timed, so
// that two cores are enough to study 128 threads. The work of a block's run is its collisions plus
// 0.14 for each disc in it, which is proportional to its time on one core. Threads take blocks in
// turn, as in OpenMP's dynamic schedule. A round ends when the last thread has finished, and
// repeated rounds count, too. The speed-up is the work of one thread, with the windows and blocks
// that it would choose, divided by the time of many threads. The share of idle time is 1 - work /
// (threads time). Sorting into cells, halos and commits are not included.
//   block_spans [DISCS [THREADS [SCENE]]]        a million discs, 64 threads, all scenes
// Scene 0 is a gas of packing 0.5 that fills its box, scene 1 the same gas in one hundredth of a
// box. In scene 2 half of it is there, and the other half is spread over the rest.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <queue>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "crowded_gas.hpp"
#include "event_driven/event_driven_engine.hpp"
#include "initial_state/initial_state.hpp"
#include "parallel/communicator.hpp"
#include "parallel/mpi.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;

namespace {

constexpr double per_disc = 0.14;

double work_of(const BlockWork& block) {
    return static_cast<double>(block.n_carried) + per_disc * static_cast<double>(block.n_seen);
}

/// The time in which `n_threads` finish the blocks, if each takes the next one when it is free.
double span_of(const std::vector<BlockWork>& round, int n_threads) {
    std::priority_queue<double, std::vector<double>, std::greater<>> free_at;
    for (int k = 0; k < n_threads; ++k) free_at.push(0);
    double end = 0;
    for (const BlockWork& block : round) {
        const double done = free_at.top() + work_of(block);
        free_at.pop();
        free_at.push(done);
        end = std::max(end, done);
    }
    return end;
}

struct Shared {
    double work = 0, span = 0;
    std::size_t n_windows = 0, n_rounds = 0, n_blocks = 0;
};

Shared shared_by(int n_threads, std::size_t n_discs, Crowd kind) {
    const Communicator& world = Communicator::world();
    const double side = std::sqrt(static_cast<double>(n_discs) * 3.14159265 / 0.5);
    const std::string text = fmt::format(
        "[box]\nsize = {}\n[discs]\ncount = {}\nradius = 1\nspeed = 0.5\n"
        "[time]\nsteps = 32\nmethod = \"event-driven\"\n",
        side, n_discs);
    SceneParameters scene = read_scene(text, "gas.toml");
    const std::vector<InputDisc> inputs = crowded(initial_state(scene, nullptr, world), scene.box,
                                                  kind);
    scene.n_discs = inputs.size();
    scene.box = box_around(scene.box, kind);
    StoredState state;
    for (const InputDisc& input : inputs) state.discs.push_back(first_state(input, scene));
    Tuning tuning;
    tuning.threads = n_threads;
    BlockTuning blocks;
    blocks.notes_work = true;
    EventDrivenEngine<PlainDynamics> engine(scene, std::move(state), world, tuning, blocks);
    Shared shared;
    while (engine.micro_steps_done() < scene.steps * scene.micro_steps) {
        engine.advance_towards(scene.steps);
        for (const std::vector<BlockWork>& round : engine.take_work()) {
            for (const BlockWork& block : round) shared.work += work_of(block);
            shared.span += span_of(round, n_threads);
            shared.n_rounds += 1;
            shared.n_blocks += round.size();
        }
    }
    shared.n_windows = static_cast<std::size_t>(engine.rollback_counts().windows);
    return shared;
}

void study(const char* name, std::size_t n_discs, int n_threads, Crowd kind) {
    const Shared one = shared_by(1, n_discs, kind), many = shared_by(n_threads, n_discs, kind);
    std::printf("%s,%zu,%d,%zu,%zu,%.1f,%.4g,%.4g,%.4g,%.2f,%.1f,%.2f\n", name, n_discs, n_threads,
                many.n_windows, many.n_rounds,
                static_cast<double>(many.n_blocks) / static_cast<double>(many.n_rounds), one.work,
                many.work, many.span, 1 - many.work / (many.span * n_threads), one.work / many.span,
                one.work / many.span / n_threads);
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
    Mpi mpi(argc, argv);
    return run_on_all(Communicator::world(), [&](const Communicator&) {
        const auto n_discs = static_cast<std::size_t>(argc > 1 ? std::atof(argv[1]) : 1e6);
        const int n_threads = argc > 2 ? std::atoi(argv[2]) : 64;
        const int scene = argc > 3 ? std::atoi(argv[3]) : -1;
        std::printf(
            "scene,discs,threads,windows,rounds,blocks a round,work of one thread,work,span,"
            "idle,speed-up,efficiency\n");
        if (scene < 0 || scene == 0) study("even", n_discs, n_threads, Crowd::none);
        if (scene < 0 || scene == 1) study("all in 1 %", n_discs, n_threads, Crowd::all);
        if (scene < 0 || scene == 2) study("half in 1 %", n_discs, n_threads, Crowd::half);
        return 0;
    });
}
