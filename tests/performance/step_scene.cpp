// SPDX-License-Identifier: BSD-3-Clause
// Steps a scene from its start to its end, with the averages of every run, and does nothing else:
// no output, and no progress that depends on the clock. So the same scene takes the same
// instructions every time, which instructions.py counts. This program needs no HDF5.
//   step_scene SCENE [THREADS]
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "core/errors.hpp"
#include "initial_state/initial_state.hpp"
#include "measure/sampler.hpp"
#include "parallel/communicator.hpp"
#include "parallel/mpi.hpp"
#include "scene/read_scene.hpp"
#include "simulation/advance.hpp"
#include "simulation/disc_system.hpp"

using namespace carrom;

int main(int argc, char** argv) {
    Mpi mpi(argc, argv);
    return run_on_all(Communicator::world(), [&](const Communicator& world) {
        if (argc != 2 && argc != 3)
            throw InputError({{"step_scene", 0,
                               "needs a scene that generates its discs, and optionally the number "
                               "of threads of a rank"}});
        Tuning tuning;
        if (argc == 3) tuning.threads = std::atoi(argv[2]);
        std::ifstream file = open_input(argv[1]); // on every rank
        const SceneParameters scene = read_scene(read_scene_text(file, argv[1]));
        DiscSystem system(scene, initial_state(scene, nullptr, world, tuning.threads), world,
                          tuning);
        Sampler sampler(scene, system, world);
        sampler.sample_if_due();
        StepAction* const actions[] = {&sampler};
        advance_to(system, scene.steps, actions);
        const Totals totals = system.totals();
        if (world.is_root()) std::printf("%s\n", to_string(totals.hash).c_str());
        return 0;
    });
}
