// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/passive_threads.hpp"

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <unistd.h>

namespace carrom {

namespace {

/// valgrind does not follow a program that starts another one.
bool is_in_valgrind() {
    const char* const preloaded = std::getenv("LD_PRELOAD");
    return preloaded != nullptr &&
           std::string_view(preloaded).find("vgpreload") != std::string_view::npos;
}

} // namespace

void let_threads_sleep(char** arguments) {
    if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr ||
        is_in_valgrind())
        return;
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error || setenv("OMP_WAIT_POLICY", "passive", 0) != 0) return;
    execv(program.c_str(), arguments); // returns only if it fails
}

} // namespace carrom
