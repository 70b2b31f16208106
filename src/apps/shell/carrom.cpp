// SPDX-License-Identifier: BSD-3-Clause
// The program `carrom`: every rank runs this, and all of them leave with the same exit code.
#include "apps/shell/command_line.hpp"
#include "apps/shell/standard_streams.hpp"
#include "apps/shell/stop_signals.hpp"
#include "io/start_io.hpp"
#include "parallel/mpi.hpp"

int main(int argc, char** argv) {
    carrom::keep_standard_streams();
    const carrom::Action action = carrom::parse_command_line(argc, argv);
    if (action.stops_on_request) carrom::note_stop_signals();
    carrom::start_io();
    const carrom::Mpi mpi(argc, argv,
                          action.needs_mpi ? carrom::Mpi::Start::always
                                           : carrom::Mpi::Start::under_launcher);
    return carrom::run_on_all(
        carrom::Communicator::world(), [&action](const carrom::Communicator& ranks) {
            const carrom::ExitCode code = action.act(ranks);
            const bool is_told = carrom::finish_standard_output();
            return static_cast<int>(is_told || code != carrom::ExitCode::success
                                        ? code
                                        : carrom::ExitCode::output_failure);
        });
}
