// SPDX-License-Identifier: BSD-3-Clause
// The program `carrom`. Every rank runs it, and all ranks end with the same exit code.
#include "apps/shell/command_line.hpp"
#include "apps/shell/passive_threads.hpp"
#include "apps/shell/standard_streams.hpp"
#include "apps/shell/stop_signals.hpp"
#include "io/start_io.hpp"
#include "machine/machine.hpp"
#include "parallel/launcher.hpp"
#include "parallel/mpi.hpp"

namespace {

/// Returns false and prints the reason once if the launcher of another MPI library has started
/// several copies of the program. Each copy would otherwise run the whole scene as a single rank.
bool is_started_well(const carrom::Communicator& ranks) {
    const carrom::LoneProcess process = carrom::lone_process(ranks.size());
    if (!process.problem.empty() && process.is_first)
        carrom::print_message("the launcher {}\n", process.problem);
    return process.problem.empty();
}

} // namespace

int main(int argc, char** argv) {
    carrom::keep_standard_streams();
    const carrom::Action action = carrom::parse_command_line(argc, argv);
    if (const std::string limit = carrom::limit_in_the_way();
        !limit.empty() && (action.needs_mpi || carrom::has_launcher())) {
        if (carrom::is_first_process()) carrom::print_message("carrom: {}\n", limit);
        return static_cast<int>(carrom::ExitCode::collective_failure);
    }
    if (action.needs_mpi || action.stops_on_request) carrom::let_threads_sleep(argv);
    if (action.stops_on_request) carrom::record_stop_signals();
    carrom::guard_exit();
    carrom::start_io();
    const carrom::Mpi mpi(argc, argv,
                          action.needs_mpi ? carrom::Mpi::Start::always
                                           : carrom::Mpi::Start::under_launcher);
    return carrom::run_on_all(
        carrom::Communicator::world(), [&action](const carrom::Communicator& ranks) {
            if (!is_started_well(ranks)) return static_cast<int>(carrom::ExitCode::bad_input);
            const carrom::ExitCode code = action.act(ranks);
            const bool is_told = carrom::finish_standard_output();
            return static_cast<int>(is_told || code != carrom::ExitCode::success
                                        ? code
                                        : carrom::ExitCode::output_failure);
        });
}
