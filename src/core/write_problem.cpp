// SPDX-License-Identifier: BSD-3-Clause
#include "core/write_problem.hpp"

#include <cerrno>
#include <cstring>

namespace carrom {

WriteProblem write_problem(const std::string& what, int error) {
    const bool is_failure = error == ENOSPC || error == EDQUOT || error == EIO || error == EROFS ||
                            error == EACCES || error == EPERM;
    return {what + ": " + std::strerror(error), is_failure};
}

} // namespace carrom
