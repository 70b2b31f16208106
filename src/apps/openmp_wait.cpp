// SPDX-License-Identifier: BSD-3-Clause
#include "apps/openmp_wait.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <unistd.h>

namespace carrom {

void bound_openmp_wait(char** arguments) {
    if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr)
        return;
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink(
        "/proc/self/exe", error); // its own name, for `ps`
    if (error || setenv("GOMP_SPINCOUNT", "3000", 1) != 0) return;
    ::execv(program.c_str(), arguments);
}

} // namespace carrom
