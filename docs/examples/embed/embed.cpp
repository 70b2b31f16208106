// SPDX-License-Identifier: BSD-3-Clause
// Runs a scene of a file, or a gas that is made here, to its end: embed [SCENE]
// Prints the state hash that `carrom run` prints for the same scene.
#include <cstdio>

#include <carrom/carrom.hpp>

carrom::Scene gas() {
    carrom::Scene scene;
    scene.set("box.size", 100).set("discs.count", 500).set("discs.radius", 1.0);
    scene.set("discs.speed", 0.5).set("time.method", "event-driven").set("time.steps", 200);
    return scene;
}

int main(int argc, char** argv) {
    const carrom::Session session; // starts MPI
    return session.run([&] {
        const auto scene = argc > 1 ? carrom::Scene::from_file(session, argv[1]) : gas();
        carrom::Simulation simulation(session, scene);
        while (simulation.step() < simulation.scene().steps) {
            simulation.advance(1);
            const carrom::Totals totals = simulation.totals(); // every rank takes part
            if (session.is_root() && simulation.step() % 50 == 0)
                std::printf("energy %g\n", totals.kinetic_energy);
        }
        const std::string hash = to_string(simulation.totals().hash);
        if (session.is_root()) std::printf("state hash %s\n", hash.c_str());
        return 0;
    });
}
