// SPDX-License-Identifier: BSD-3-Clause
// The cost of random insertion, counted and not timed: calls that involve all ranks, messages,
// bytes, and a hash of the positions, which must not depend on ranks or threads. Valgrind counts
// instructions: --tool=callgrind --collect-atstart=no '--toggle-collect=carrom::insert_at_random*'.
//   insertion_costs [DISCS [PACKING [THREADS]]]        100000 discs at 0.5, one thread
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "core/state_hash.hpp"
#include "initial_state/random_insertion.hpp"
#include "parallel/communicator.hpp"
#include "parallel/mpi.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;

int main(int argc, char** argv) {
    Mpi mpi(argc, argv);
    return run_on_all(Communicator::world(), [&](const Communicator& world) {
        const double n_discs = argc > 1 ? std::atof(argv[1]) : 1e5,
                     packing = argc > 2 ? std::atof(argv[2]) : 0.5;
        const int n_threads = argc > 3 ? std::atoi(argv[3]) : 1;
        const std::string text = fmt::format("[box]\nsize = 1000\n[discs]\ncount = {:.0f}\n"
                                             "packing = {}\nspeed = 1\n[time]\nsteps = 1\n",
                                             n_discs, packing);
        const SceneParameters scene = read_scene(text, "gas.toml");
        const Traffic before = world.traffic();
        std::vector<DiscState> states;
        for (const InputDisc& input : insert_at_random(scene, world, n_threads)) {
            DiscState& disc = states.emplace_back();
            disc.id = input.id;
            disc.x = input.x;
            disc.y = input.y;
        }
        const Traffic after = world.traffic();
        StateHash hash = hash_of(states);
        std::uint64_t sums[] = {hash.low, hash.high, after.messages - before.messages,
                                after.bytes - before.bytes};
        world.sum(sums);
        if (!world.is_root()) return 0;
        std::printf("discs,packing,ranks,threads,collectives,messages,bytes,hash\n"
                    "%.0f,%g,%d,%d,%llu,%llu,%llu,%s\n",
                    n_discs, packing, world.size(), n_threads,
                    static_cast<unsigned long long>(after.collectives - before.collectives),
                    static_cast<unsigned long long>(sums[2]),
                    static_cast<unsigned long long>(sums[3]),
                    to_string(StateHash{sums[0], sums[1]}).c_str());
        return 0;
    });
}
