// SPDX-License-Identifier: BSD-3-Clause
// Steps a scene on OMP_NUM_THREADS threads, in one call or in short calls. After each short call it
// reads all positions, like a program that analyses a run. look_costs.py counts the instructions of
// `step_and_look` and of the functions that it calls.
//   look_costs SCENE STEPS EVERY [KEY=VALUE ...]    EVERY: steps between reads; 0: no reads
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <carrom/carrom.hpp>

using namespace carrom;

namespace {

/// then the gas is homogeneous, and its collision rate is known
constexpr std::int64_t steps_before = 64;

void step_to(Simulation& simulation, std::int64_t last, std::int64_t every,
             std::vector<double>& xy) {
    while (every > 0 && simulation.step() < last) {
        simulation.advance(std::min(every, last - simulation.step()));
        simulation.read_positions(xy);
    }
    simulation.advance_to(last);
}

} // namespace

/// The part whose instructions are counted. Not inlined, so that it has a name.
[[gnu::noinline]] void step_and_look(Simulation& simulation, std::int64_t last, std::int64_t every,
                                     std::vector<double>& xy) {
    step_to(simulation, last, every, xy);
}

int main(int argc, char** argv) {
    const Session session;
    return session.run([&] {
        if (argc < 4)
            throw InputError(
                {{"look_costs", 0, "needs a scene, steps, and steps from look to look"}});
        Scene scene = Scene::from_file(session, argv[1]);
        const std::int64_t last = steps_before + std::atoll(argv[2]), every = std::atoll(argv[3]);
        // Twice as many steps, so that the run does not end with the last read
        scene.set("time.steps", 2 * last);
        for (int k = 4; k < argc; ++k) {
            const std::string setting = argv[k];
            const std::size_t sign = setting.find('=');
            scene.set(setting.substr(0, sign), std::string_view(setting).substr(sign + 1));
        }
        Simulation simulation(session, scene);
        std::vector<double> xy(2 * simulation.scene().n_discs);
        step_to(simulation, steps_before, every, xy);
        const Totals before = simulation.totals();
        step_and_look(simulation, last, every, xy);
        const Totals after = simulation.totals();
        const double rate = 2 *
                            static_cast<double>(after.pair_collisions - before.pair_collisions) /
                            static_cast<double>(simulation.scene().n_discs) /
                            static_cast<double>(last - steps_before);
        if (session.rank() == 0) std::printf("%s %.4f\n", to_string(after.hash).c_str(), rate);
        return 0;
    });
}
