// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/passive_threads.hpp"

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include <omp.h>
#include <sched.h>
#include <unistd.h>

namespace carrom {

namespace {

/// GNU's OpenMP library needs 20 to 50 microseconds for 1000 spins, about as long as it takes to
/// wake a thread. With 10,000 spins, cores with several threads lost half their time
/// (docs/understanding/performance).
constexpr const char* spins_before_sleep = "1000";

/// Whether the program runs under valgrind, which cannot follow a program that restarts itself.
bool is_in_valgrind() {
    const char* const preloaded = std::getenv("LD_PRELOAD");
    return preloaded != nullptr &&
           std::string_view(preloaded).find("vgpreload") != std::string_view::npos;
}

/// Allows this thread to run on all processors that OpenMP may use. If threads are bound, OpenMP
/// has already bound this thread to one place, and the restarted program would inherit this limit.
void unbind() {
    cpu_set_t processors;
    CPU_ZERO(&processors);
    for (int place = 0; place < omp_get_num_places(); ++place) {
        std::vector<int> ids(static_cast<std::size_t>(omp_get_place_num_procs(place)));
        omp_get_place_proc_ids(place, ids.data());
        for (const int id : ids)
            if (id < CPU_SETSIZE) CPU_SET(id, &processors);
    }
    if (CPU_COUNT(&processors) > 0) sched_setaffinity(0, sizeof processors, &processors);
}

} // namespace

void let_threads_sleep(char** arguments) {
    if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr ||
        is_in_valgrind())
        return;
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error || setenv("OMP_WAIT_POLICY", "passive", 0) != 0 ||
        setenv("GOMP_SPINCOUNT", spins_before_sleep, 0) != 0)
        return;
    unbind();
    execv(program.c_str(), arguments); // returns only if it fails
}

} // namespace carrom
