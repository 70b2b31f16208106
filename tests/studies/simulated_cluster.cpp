// SPDX-License-Identifier: BSD-3-Clause
// Steps a scene on the ranks of a simulated cluster (simulated_ranks.hpp), and prints what is sent
// and how long it would take. Discs are really stepped, so messages are those of a real run.
// Computing times are given to the simulation and not measured, so the same run gives the same
// numbers on any machine.
//   simulated_cluster PLATFORM RANKS RANKS_PER_NODE SCENE STEPS NS_OWN NS_HALO STANDS_FOR WINDOW
// The first interval between two syncs is not counted; then STEPS steps count. A rank computes for
// NS_OWN nanoseconds per own disc and micro-step and for NS_HALO per disc that it has sent (it
// receives as many). If a disc stands for several, computing and sending take as many times longer.
// Then WINDOW gives the number of micro-steps of a window (0: the engine chooses), because the
// engine would choose longer ones if discs collide less often. Prints one line, with the columns
// that `simulated_cluster` prints without arguments: per rank and step, means over ranks unless
// stated otherwise.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <mpi.h>

#include "core/disc_state.hpp"
#include "core/errors.hpp"
#include "initial_state/initial_state.hpp"
#include "parallel/communicator.hpp"
#include "scene/read_scene.hpp"
#include "simulated_ranks.hpp"
#include "simulation/disc_system.hpp"

using namespace carrom;

namespace {

std::uint64_t n_any_to_any = 0; ///< calls of all ranks so far

} // namespace

// The linker puts this function in the place of MPI_Alltoall (CMakeLists.txt), to count calls whose
// messages grow with the number of ranks.
extern "C" int __real_MPI_Alltoall(const void*, int, MPI_Datatype, void*, int, MPI_Datatype,
                                   MPI_Comm); // NOLINT
extern "C" int __wrap_MPI_Alltoall(const void* out, int n_out, MPI_Datatype out_type, void* in,
                                   int n_in, MPI_Datatype in_type, MPI_Comm comm) { // NOLINT
    ++n_any_to_any;
    return __real_MPI_Alltoall(out, n_out, out_type, in, n_in, in_type, comm);
}

namespace {

/// Counts of one rank over the counted steps.
struct Tally {
    Traffic traffic;
    double own_seconds = 0,
           seconds = 0; ///< time of computing for own discs, and whole time with communication
    std::uint64_t network_messages =
        0; ///< messages of all ranks, with those inside collective operations
    std::uint64_t any_to_any = 0; ///< calls of all ranks
    std::int64_t steps = 0;
    std::string hash;
};

struct Job {
    std::string scene;
    std::int64_t steps;
    double ns_own, ns_halo;
    Tuning tuning;
    std::vector<Tally> tallies;
    std::vector<std::vector<InputDisc>> dealt{}; ///< discs by the rank in whose strip they start
};

Traffic difference(const Traffic& after, const Traffic& before) {
    return {after.messages - before.messages, after.bytes - before.bytes,
            after.collectives - before.collectives};
}

/// The scene's discs that start in this rank's strip. They get there through memory, not the
/// network: a million messages at once between 1024 ranks would take the simulation hours, and the
/// start of a run is not studied. **Collective.**
std::vector<InputDisc> discs_of_strip(Job& job, int rank, const SceneParameters& scene,
                                      const Communicator& world) {
    const auto n_ranks = static_cast<double>(job.dealt.size());
    for (const InputDisc& disc : initial_state(scene, nullptr, world))
        job.dealt[static_cast<std::size_t>(
                      std::clamp(disc.x / scene.box.x * n_ranks, 0.0, n_ranks - 1))]
            .push_back(disc);
    world.barrier();
    return std::move(job.dealt[static_cast<std::size_t>(rank)]);
}

/// The work of a rank between start and end of MPI.
void step(Job& job, int rank) {
    const Communicator world = Communicator::world();
    std::ifstream file = open_input(job.scene);
    const SceneParameters scene = read_scene(read_scene_text(file, job.scene));
    DiscSystem system(scene, discs_of_strip(job, rank, scene, world), world, job.tuning);
    const std::int64_t first = scene.sync_every / scene.micro_steps, last = first + job.steps;
    while (system.step() < first) system.advance_towards(first);
    world.barrier();
    Tally& tally = job.tallies[static_cast<std::size_t>(rank)];
    const double start = MPI_Wtime();
    const Traffic at_start = world.traffic();
    const std::uint64_t messages_at_start = n_network_messages(),
                        any_to_any_at_start = n_any_to_any;
    while (system.step() < last) {
        const std::int64_t micro_steps = system.micro_steps_done();
        const std::uint64_t bytes = world.traffic().bytes;
        system.advance_towards(last);
        const double own = job.ns_own * static_cast<double>(system.discs().size()) *
                           static_cast<double>(system.micro_steps_done() - micro_steps);
        compute_for(own + job.ns_halo * static_cast<double>(world.traffic().bytes - bytes) /
                              sizeof(DiscState));
        tally.own_seconds += own * 1e-9;
    }
    tally.traffic = difference(world.traffic(), at_start);
    world.barrier();
    tally.seconds = MPI_Wtime() - start;
    tally.network_messages = n_network_messages() - messages_at_start;
    tally.any_to_any = n_any_to_any - any_to_any_at_start;
    tally.steps = system.step() - first;
    tally.hash = to_string(system.totals().hash);
}

/// Prints means and largest values over ranks, per rank and step.
void print_row(const Job& job, std::uint64_t n_discs) {
    const auto n_ranks = static_cast<double>(job.tallies.size());
    const Tally& first = job.tallies.front();
    const auto n_steps = static_cast<double>(first.steps);
    double messages = 0, bytes = 0, own_seconds = 0, most_messages = 0, most_bytes = 0;
    for (const Tally& tally : job.tallies) {
        messages += static_cast<double>(tally.traffic.messages);
        bytes += static_cast<double>(tally.traffic.bytes);
        own_seconds += tally.own_seconds;
        most_messages = std::max(most_messages, static_cast<double>(tally.traffic.messages));
        most_bytes = std::max(most_bytes, static_cast<double>(tally.traffic.bytes));
    }
    std::printf(
        "%zu,%llu,%lld,%.4f,%.4f,%.1f,%.1f,%.4f,%.4f,%.4f,%.4g,%.4g,%.4f,%s\n", job.tallies.size(),
        static_cast<unsigned long long>(n_discs), static_cast<long long>(first.steps),
        messages / n_ranks / n_steps, most_messages / n_steps, bytes / n_ranks / n_steps,
        most_bytes / n_steps, static_cast<double>(first.traffic.collectives) / n_steps,
        static_cast<double>(first.any_to_any) / n_ranks / n_steps,
        static_cast<double>(first.network_messages) / n_ranks / n_steps, first.seconds / n_steps,
        own_seconds / n_ranks / n_steps, own_seconds / n_ranks / first.seconds, first.hash.c_str());
}

constexpr const char* heading = "ranks,n_discs,steps,messages,most_messages,bytes,most_bytes,"
                                "collectives,any_to_any,network_messages,"
                                "step_seconds,own_seconds,efficiency,state_hash";

} // namespace

int main(int argc, char** argv) {
    if (argc == 1) {
        std::printf("%s\n", heading);
        return 0;
    }
    if (argc < 10) {
        std::fprintf(stderr, "simulated_cluster PLATFORM RANKS RANKS_PER_NODE SCENE STEPS NS_OWN "
                             "NS_HALO STANDS_FOR WINDOW\n");
        return 2;
    }
    SimulatedCluster cluster{argv[1], std::stoi(argv[2]), std::stoi(argv[3]), std::stod(argv[8])};
    Job job{argv[4],
            std::stoll(argv[5]),
            std::stod(argv[6]) * cluster.bytes_stand_for,
            std::stod(argv[7]) * cluster.bytes_stand_for,
            {},
            {}};
    if (const double window = std::stod(argv[9]); window > 0) job.tuning.window = window;
    job.tallies.resize(static_cast<std::size_t>(cluster.n_ranks));
    job.dealt.resize(job.tallies.size());
    run_simulated(argc, argv, cluster, [&job](int rank) { step(job, rank); });
    std::ifstream file = open_input(job.scene);
    print_row(job, read_scene(read_scene_text(file, job.scene)).n_discs);
    return 0;
}
