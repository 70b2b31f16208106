// SPDX-License-Identifier: BSD-3-Clause
// The program `carrom`: every rank runs this, and all of them leave with the same exit code.
#include "apps/command_line.hpp"
#include "apps/openmp_wait.hpp"
#include "apps/standard_streams.hpp"
#include "io/start_io.hpp"
#include "parallel/mpi.hpp"

int main(int argc, char** argv) {
    carrom::keep_standard_streams();
    carrom::bound_openmp_wait(argv);
    carrom::start_io();
    const carrom::Mpi mpi(argc, argv);
    return carrom::run_on_all(
        carrom::Communicator::world(), [&](const carrom::Communicator& ranks) {
            const carrom::Action action = carrom::parse_command_line(argc, argv);
            return static_cast<int>(action(ranks));
        });
}
