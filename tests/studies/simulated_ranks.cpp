// SPDX-License-Identifier: BSD-3-Clause
#include "simulated_ranks.hpp"

#include <mpi.h>
#include <simgrid/kernel/resource/Action.hpp>
#include <simgrid/s4u.hpp>
#include <smpi/smpi.h>

namespace carrom {

namespace {

std::uint64_t n_messages = 0;

void configure(double bytes_stand_for) {
    using simgrid::s4u::Engine;
    Engine::set_config("smpi/simulate-computation:no");
    // latency + bytes / bandwidth, shared by all messages on a link
    Engine::set_config("network/model:CM02");
    Engine::set_config("network/TCP-gamma:0");
    Engine::set_config("network/bandwidth-factor:" + std::to_string(1 / bytes_stand_for));
    Engine::set_config("smpi/coll-selector:ompi");
    Engine::set_config("smpi/host-speed:1Gf");
    // ranks can share all variables of the program
    Engine::set_config("smpi/privatization:no");
}

} // namespace

void run_simulated(int& argc, char** argv, const SimulatedCluster& cluster,
                   const std::function<void(int)>& life) {
    simgrid::s4u::Engine engine(&argc, argv);
    SMPI_init(); // reads the settings
    configure(cluster.bytes_stand_for);
    engine.load_platform(cluster.platform);
    simgrid::s4u::Link::on_communication_state_change_cb(
        [](const simgrid::kernel::resource::NetworkAction&,
           simgrid::kernel::resource::Action::State before) {
            if (before == simgrid::kernel::resource::Action::State::STARTED) ++n_messages;
        });
    SMPI_app_instance_register("carrom", nullptr, cluster.n_ranks);
    for (int rank = 0; rank < cluster.n_ranks; ++rank) {
        const int node = rank / cluster.ranks_per_node;
        const simgrid::s4u::ActorPtr actor = simgrid::s4u::Actor::init(
            "rank-" + std::to_string(rank), engine.host_by_name("node-" + std::to_string(node)));
        actor->set_property("instance_id", "carrom");
        actor->set_property("rank", std::to_string(rank));
        actor->start([&life, rank] {
            MPI_Init(nullptr, nullptr); // not by class Mpi, because SMPI has no support for threads
            life(rank);
            MPI_Finalize();
        });
    }
    engine.run();
    SMPI_finalize();
}

void compute_for(double nanoseconds) {
    constexpr double flops_per_nanosecond = 1; // speed of every host in the platform file
    smpi_execute_flops(nanoseconds * flops_per_nanosecond);
}

std::uint64_t n_network_messages() { return n_messages; }

} // namespace carrom
