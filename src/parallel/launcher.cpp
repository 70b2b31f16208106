// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/launcher.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "parallel/mpi.hpp"

namespace carrom {

namespace {

/// The variables in which a launcher stores the number of processes and this process's number.
struct LauncherVariables {
    const char *size, *rank;
};
constexpr std::array known_launchers = {
    LauncherVariables{"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"}, // mpirun of Open MPI
    LauncherVariables{"PMI_SIZE", "PMI_RANK"}, // MPICH, Intel MPI, and srun with PMI-2
    LauncherVariables{"SLURM_STEP_NUM_TASKS", "SLURM_PROCID"}}; // srun

int number_in(const char* variable) {
    const char* const text = std::getenv(variable);
    return text == nullptr ? 0 : std::atoi(text);
}

} // namespace

bool has_launcher() {
    constexpr std::array variables = {
        "OMPI_COMM_WORLD_SIZE", // mpirun of Open MPI
        "PMIX_RANK",
        "PMI_RANK",      // many launchers, among them srun and MPICH's mpiexec
        "SLURM_STEP_ID", // srun
        "PALS_RANKID",
        "ALPS_APP_PE", // Cray
        "FLUX_TASK_RANK"};
    return std::any_of(variables.begin(), variables.end(),
                       [](const char* name) { return std::getenv(name) != nullptr; });
}

bool is_first_process() {
    return std::all_of(known_launchers.begin(), known_launchers.end(), [](const auto& variables) {
        return number_in(variables.size) <= 1 || number_in(variables.rank) == 0;
    });
}

LoneProcess lone_process(int n_ranks) {
    if (n_ranks > 1) return {};
    for (const auto& [size, rank] : known_launchers) {
        const int n_started = number_in(size);
        if (n_started <= 1) continue;
        return {"has started " + std::to_string(n_started) + " processes (" + size +
                    "), but each of them is alone for " + mpi_version() +
                    ", which this program was built with; use the launcher of that library "
                    "(carrom --version names it; with srun, another --mpi)",
                number_in(rank) == 0};
    }
    return {};
}

} // namespace carrom
