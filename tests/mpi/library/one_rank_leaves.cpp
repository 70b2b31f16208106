// SPDX-License-Identifier: BSD-3-Clause
// A program with a mistake: one rank returns, or throws, and the others go on. The library must end
// all of them with a message. Argument: return, throw or caught.
#include <string_view>
#include <vector>

#include <carrom/carrom.hpp>

#include "library_runs.hpp"

using namespace carrom;

int main(int argc, char** argv) {
    const std::string_view how = argc > 1 ? argv[1] : "";
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
