// SPDX-License-Identifier: BSD-3-Clause
// A program with a mistake: one rank returns, or throws, and the others go on. The library must end
// all of them with a message. Or the program ends MPI before its session. Argument: return, throw,
// caught or finalize.
#include <string>
#include <string_view>
#include <vector>

#include <carrom/carrom.hpp>
#include <mpi.h>

#include "library_runs.hpp"

using namespace carrom;

namespace {

/// Calls after the end of MPI are errors, and destructors print nothing. Returns an exit code.
int end_mpi_first() {
    const Session session;
    Simulation simulation(session, test::gas("event-driven", 20));
    TrajectoryWriter writer(simulation, "finalize_frames.h5");
    simulation.advance(2);
    MPI_Finalize();
    const std::string problem = test::problems_of([&] { simulation.advance(1); });
    return problem.find("MPI has ended") == std::string::npos ? 1 : 0;
}

} // namespace

int main(int argc, char** argv) {
    const std::string_view how = argc > 1 ? argv[1] : "";
    if (how == "finalize") return end_mpi_first();
    const Session session;
    const auto body = [&] {
        Simulation simulation(session, test::gas("event-driven", 20));
        simulation.advance(2);
        if (session.rank() == session.size() - 1) {
            if (how == "return") return 0;
            throw InputError({{"a test", 0, "of one rank"}});
        }
        simulation.advance(2);
        return static_cast<int>(simulation.totals().n_discs > 0);
    };
    if (how != "caught") return session.run(body);
    try {
        return body();
    } catch (const InputError&) {
        return 0;
    }
}
