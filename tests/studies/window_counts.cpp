// SPDX-License-Identifier: BSD-3-Clause
// Counts what a window of the event-driven method does on many ranks, each with one thread: work of
// blocks, halos, messages, collective operations and rollbacks. All ranks run for real in this one
// process (simulated_ranks.hpp), so the counts are those of a real run. cluster_model.py takes
// its figures from here.
//
//   window_counts PLATFORM RANKS DISCS PACKING STEPS HALO CROWD ACROSS
//
// HALO is the halo of a block's first run in reaches (0: as the engine chooses). CROWD is 0 for an
// even gas, 1 if all discs lie in one hundredth of the box, 2 if half of them do. ACROSS is the
// number of ranks that share a strip (0: as the engine chooses). The first 32 steps are left out,
// because discs start from a lattice, and 256 of a crowd, because cuts between ranks follow counted
// work. One line on standard output, as in the heading that the program prints when it is called
// without arguments. Collisions, those that first runs of blocks carry out, and discs of these runs
// are counted for each disc and window. "busiest" is the work of first runs on the busiest rank
// over the mean. "span" is the work that all ranks wait for, repeated runs included, for each disc
// of a rank and window: a rank's work is the collisions that it carries out plus 0.14 for each disc
// in its blocks and their halos.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <mpi.h>

#include "crowded_gas.hpp"
#include "event_driven/event_driven_engine.hpp"
#include "initial_state/initial_state.hpp"
#include "parallel/communicator.hpp"
#include "scene/read_scene.hpp"
#include "simulated_ranks.hpp"

using namespace carrom;

namespace {

constexpr double per_disc = 0.14; ///< work of a disc in a block or its halo, in collisions

using Rounds = std::vector<std::vector<BlockWork>>;

struct Tally {
    Traffic before, after;
    RollbackCounts counts_before, counts_after;
    std::uint64_t n_own = 0, n_collisions = 0;
    double micro_steps = 0;
    int n_across = 1;
    Rounds rounds{};
};

struct Job {
    double n_discs = 0, packing = 0;
    std::int64_t steps = 0;
    int halo = 0, across = 0;
    Crowd crowd = Crowd::none;
    std::vector<Tally> tallies{};
    std::vector<InputDisc> inputs{}; ///< discs of all ranks, which share this memory
    std::vector<DiscStates> dealt{}; ///< discs by the rank in whose strip they start

    /// Steps that are not counted, until the lattice has become a gas, or until cuts have followed
    /// the clusters.
    std::int64_t n_first() const { return crowd == Crowd::none ? 32 : 256; }
};

SceneParameters gas(const Job& job) {
    const double side = std::sqrt(job.n_discs * 3.14159265 / job.packing);
    return read_scene(fmt::format("[box]\nsize = {}\n[discs]\ncount = {:.0f}\nradius = 1\n"
                                  "generator = \"lattice\"\nspeed = 0.5\n"
                                  "[time]\nsteps = {}\nmethod = \"event-driven\"\n",
                                  side, job.n_discs, job.n_first() + job.steps),
                      "gas.toml");
}

/// The discs that start in this rank's strip. They get there through memory, because the start of a
/// run is not counted. **Collective.**
DiscStates discs_of(Job& job, std::size_t rank, SceneParameters& scene, const Communicator& world) {
    const std::vector<InputDisc> share = initial_state(scene, nullptr, world);
    job.inputs.insert(job.inputs.end(), share.begin(), share.end());
    world.barrier();
    const Box corner = scene.box;
    scene.box = box_around(corner, job.crowd);
    if (rank == 0) {
        std::ranges::sort(job.inputs, {}, &InputDisc::id);
        job.inputs = crowded(std::move(job.inputs), corner, job.crowd);
        const auto n_ranks = static_cast<double>(job.dealt.size());
        for (const InputDisc& input : job.inputs)
            job.dealt[static_cast<std::size_t>(
                          std::clamp(input.x / scene.box.x * n_ranks, 0.0, n_ranks - 1))]
                .push_back(first_state(input, scene));
    }
    world.barrier();
    scene.n_discs = job.inputs.size();
    return std::move(job.dealt[rank]);
}

template <class Engine> std::uint64_t collisions_of(const Engine& engine) {
    std::uint64_t n = 0;
    for (const DiscState& disc : engine.own()) n += disc.pair_collisions;
    return n;
}

/// The engine stops at each sync. **Collective.**
template <class Engine>
void advance(Engine& engine, const SceneParameters& scene, std::int64_t step) {
    while (engine.micro_steps_done() < step * scene.micro_steps) engine.advance_towards(step);
}

/// The work of a rank.
void run(Job& job, int rank) {
    const Communicator world = Communicator::world();
    const auto place = static_cast<std::size_t>(rank);
    SceneParameters scene = gas(job);
    StoredState state;
    state.discs = discs_of(job, place, scene, world);
    BlockTuning blocks;
    blocks.notes_work = true;
    if (job.halo > 0) blocks.halo = job.halo;
    Tuning tuning;
    if (job.across > 0) tuning.ranks_across = job.across;
    EventDrivenEngine<PlainDynamics> engine(scene, std::move(state), world, tuning, blocks);
    advance(engine, scene, job.n_first());
    Tally& tally = job.tallies[place];
    engine.take_work();
    tally.counts_before = engine.rollback_counts();
    tally.n_collisions = world.sum(collisions_of(engine)) / 2;
    tally.micro_steps = -static_cast<double>(engine.micro_steps_done());
    tally.before = world.traffic();
    advance(engine, scene, job.n_first() + job.steps);
    tally.after = world.traffic();
    tally.micro_steps += static_cast<double>(engine.micro_steps_done());
    tally.rounds = engine.take_work();
    tally.counts_after = engine.rollback_counts();
    tally.n_collisions = world.sum(collisions_of(engine)) / 2 - tally.n_collisions;
    tally.n_across = engine.most_ranks_across();
    tally.n_own = engine.own().size();
}

struct Work {
    double first = 0, repeated = 0; ///< work of all ranks
    double busiest = 0;             ///< work of first runs on the busiest rank, summed over windows
    double span = 0; ///< work of the busiest rank, for which all others wait, summed over rounds
    double carried = 0, seen = 0; ///< collisions and discs of first runs
    double n_rounds = 0;
};

Work work_of(const Job& job) {
    Work work;
    const std::size_t n_rounds = job.tallies.front().rounds.size();
    work.n_rounds = static_cast<double>(n_rounds);
    for (std::size_t k = 0; k < n_rounds; ++k) {
        double most = 0, all = 0, carried = 0, seen = 0;
        bool is_first = false; // no rank has run its blocks before
        for (const Tally& tally : job.tallies) {
            double own = 0;
            for (const BlockWork& block : tally.rounds[k]) {
                own += static_cast<double>(block.n_carried) +
                       per_disc * static_cast<double>(block.n_seen);
                carried += static_cast<double>(block.n_carried);
                seen += static_cast<double>(block.n_seen);
                is_first |= !block.is_repeated;
            }
            most = std::max(most, own);
            all += own;
        }
        (is_first ? work.first : work.repeated) += all;
        work.span += most;
        if (!is_first) continue;
        work.busiest += most;
        work.carried += carried;
        work.seen += seen;
    }
    return work;
}

constexpr const char* heading =
    "crowd,ranks,across,discs,packing,halo,windows,micro_steps,collisions,"
    "carried,seen,busiest,span,blocks,repeated,windows_redone,rounds,"
    "repeated_work,messages,bytes,most_bytes,collectives";

void print_row(const Job& job) {
    const Work work = work_of(job);
    const Tally& tally = job.tallies.front();
    const auto n_ranks = static_cast<double>(job.tallies.size());
    const auto n_discs = static_cast<double>(job.inputs.size());
    const auto count = [&](std::uint64_t RollbackCounts::* what) {
        return static_cast<double>(tally.counts_after.*what - tally.counts_before.*what);
    };
    const double n_windows = count(&RollbackCounts::windows);
    const double n_blocks = count(&RollbackCounts::blocks);
    double messages = 0, bytes = 0, most_bytes = 0;
    for (const Tally& one : job.tallies) {
        messages += static_cast<double>(one.after.messages - one.before.messages);
        const auto sent = static_cast<double>(one.after.bytes - one.before.bytes);
        bytes += sent;
        most_bytes = std::max(most_bytes, sent);
    }
    const double per = n_windows * n_discs;
    fmt::print("{},{},{},{},{},{},{},{:.5g},{:.5g},{:.5g},{:.5g},{:.4g},{:.5g},{:.5g},{:.4g},{:.4g}"
               ",{:.4g},"
               "{:.4g},{:.5g},{:.6g},{:.6g},{:.5g}\n",
               static_cast<int>(job.crowd), n_ranks, tally.n_across, n_discs, job.packing, job.halo,
               n_windows, tally.micro_steps / n_windows,
               static_cast<double>(tally.n_collisions) / per, work.carried / per, work.seen / per,
               work.busiest * n_ranks / work.first, work.span * n_ranks / per, n_blocks / n_windows,
               count(&RollbackCounts::blocks_redone) / n_blocks,
               count(&RollbackCounts::windows_redone) / n_windows, work.n_rounds / n_windows - 1,
               work.repeated / work.first, messages / n_windows / n_ranks,
               bytes / n_windows / n_ranks, most_bytes / n_windows,
               static_cast<double>(tally.after.collectives - tally.before.collectives) / n_windows);
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 9) {
        std::printf("%s\n", heading);
        return 0;
    }
    const SimulatedCluster cluster{argv[1], std::stoi(argv[2])};
    Job job;
    job.n_discs = std::stod(argv[3]);
    job.packing = std::stod(argv[4]);
    job.steps = std::stoll(argv[5]);
    job.halo = std::stoi(argv[6]);
    job.crowd = static_cast<Crowd>(std::stoi(argv[7]));
    job.across = std::stoi(argv[8]);
    job.tallies.resize(static_cast<std::size_t>(cluster.n_ranks));
    job.dealt.resize(job.tallies.size());
    run_simulated(argc, argv, cluster, [&job](int rank) { run(job, rank); });
    print_row(job);
    return 0;
}
