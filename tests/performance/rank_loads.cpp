// SPDX-License-Identifier: BSD-3-Clause
// How evenly ranks share a scene, and how much of their discs is halo, counted and not timed. The
// event-driven method runs on all ranks of MPI, with strips and with groups of ranks that cut them
// across.
//
//   mpiexec -n RANKS rank_loads [DISCS [SCENE [ACROSS]]]     1e5 discs, all scenes, 1 and the best
//
// Scene 0 is a gas of packing 0.5 that fills its box, scene 1 the same gas in one hundredth of a
// box. In scene 2 half of it is there, and the other half is spread over the rest. ACROSS is the
// number of ranks that share a strip. Cuts move after each of the first twelve intervals between
// syncs; the next four are counted. The work of a rank is the collisions that its blocks carry out
// plus 0.14 for each disc in them, halos included. One row for each scene: discs of the halo
// over own discs, and neighbours, as means over ranks and windows; the work of first runs on the
// busiest rank over the mean, for the four intervals together and as the mean of windows; and the
// work of repeated runs of blocks over that of first runs.
// The state hash is the same for all numbers of ranks.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "core/state_hash.hpp"
#include "crowded_gas.hpp"
#include "event_driven/event_driven_engine.hpp"
#include "initial_state/initial_state.hpp"
#include "parallel/communicator.hpp"
#include "parallel/mpi.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;

namespace {

constexpr std::int64_t steps_of_interval = 8, first_intervals = 12, counted_intervals = 4;
constexpr const char* names[] = {"even", "all in 1 %", "half in 1 %"};

double work_of(const std::vector<BlockWork>& round, bool is_repeated) {
    double work = 0;
    for (const BlockWork& block : round)
        if (block.is_repeated == is_repeated)
            work += static_cast<double>(block.n_carried) +
                    work_of_disc * static_cast<double>(block.n_seen);
    return work;
}

/// The sum over ranks, each rounded down to hundredths of a collision. **Collective.**
double sum_of(double work, const Communicator& world) {
    return static_cast<double>(world.sum(static_cast<std::uint64_t>(100 * work))) / 100;
}

/// The largest value of a rank divided by the mean. **Collective.**
double unevenness(double work, const Communicator& world) {
    return world.max(work) * world.size() / sum_of(work, world);
}

SceneParameters gas(std::size_t n_discs) {
    const double side = std::sqrt(static_cast<double>(n_discs) * 3.14159265 / 0.5);
    return read_scene(
        fmt::format("[box]\nsize = {}\n[discs]\ncount = {}\nradius = 1\nspeed = 0.5\n"
                    "generator = \"lattice\"\n"
                    "[time]\nsteps = {}\nsync_every = {}\nmethod = \"event-driven\"\n",
                    side, n_discs, steps_of_interval * (first_intervals + counted_intervals),
                    steps_of_interval),
        "gas.toml");
}

/// Prints the row of a scene. **Collective.**
void study(std::size_t n_discs, Crowd crowd, std::optional<int> ranks_across,
           const Communicator& world) {
    SceneParameters scene = gas(n_discs);
    const Box corner = scene.box;
    const std::vector<InputDisc> inputs = crowded(
        initial_state(scene, nullptr, Communicator::of_this_rank()), corner, crowd);
    scene.box = box_around(corner, crowd);
    scene.n_discs = inputs.size();
    StoredState state;
    const auto n_ranks = static_cast<std::uint64_t>(world.size());
    for (const InputDisc& input : inputs)
        if (input.id % n_ranks == static_cast<std::uint64_t>(world.rank()))
            state.discs.push_back(first_state(input, scene));
    Tuning tuning;
    tuning.ranks_across = ranks_across;
    BlockTuning blocks;
    blocks.notes_work = true;
    EventDrivenEngine<PlainDynamics> engine(scene, std::move(state), world, tuning, blocks);
    const auto advance_to = [&](std::int64_t step) {
        while (engine.micro_steps_done() < step * scene.micro_steps) engine.advance_towards(step);
    };
    advance_to(steps_of_interval * first_intervals);
    engine.take_work();
    const HaloCounts before = engine.halo_counts();
    advance_to(scene.steps);
    const HaloCounts after = engine.halo_counts();
    double work = 0, repeated = 0, of_windows = 0;
    for (const std::vector<BlockWork>& round : engine.take_work()) {
        const double of_round = work_of(round, false);
        if (world.any(of_round > 0)) of_windows += unevenness(of_round, world);
        work += of_round;
        repeated += work_of(round, true);
    }
    const auto difference = [&](std::uint64_t HaloCounts::* what) {
        return static_cast<double>(world.sum(after.*what - before.*what));
    };
    const double uneven = unevenness(work, world),
                 again = sum_of(repeated, world) / sum_of(work, world),
                 n_own = difference(&HaloCounts::n_own), n_halo = difference(&HaloCounts::n_halo),
                 n_neighbours = difference(&HaloCounts::n_neighbours),
                 n_windows = difference(&HaloCounts::n_windows);
    StateHash hash = hash_of(engine.own());
    std::uint64_t halves[] = {hash.low, hash.high};
    world.sum(halves);
    if (!world.is_root()) return;
    fmt::print("{},{},{},{},{:.3f},{:.2f},{:.3f},{:.3f},{:.3f},{}\n",
               names[static_cast<int>(crowd)], scene.n_discs, world.size(),
               engine.most_ranks_across(), n_halo / n_own, n_neighbours / n_windows, uneven,
               of_windows * world.size() / n_windows, again,
               to_string(StateHash{halves[0], halves[1]}));
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
    Mpi mpi(argc, argv);
    return run_on_all(Communicator::world(), [&](const Communicator& world) {
        const auto n_discs = static_cast<std::size_t>(argc > 1 ? std::atof(argv[1]) : 1e5);
        const int scene = argc > 2 ? std::atoi(argv[2]) : -1;
        if (world.is_root())
            fmt::print("scene,discs,ranks,across,halo over own,neighbours,busiest over mean,"
                       "of windows,repeated,state hash\n");
        for (const Crowd crowd : {Crowd::none, Crowd::all, Crowd::half}) {
            if (scene >= 0 && scene != static_cast<int>(crowd)) continue;
            if (argc > 3) {
                study(n_discs, crowd, std::atoi(argv[3]), world);
            } else {
                study(n_discs, crowd, 1, world);
                study(n_discs, crowd, {}, world);
            }
        }
        return 0;
    });
}
