// SPDX-License-Identifier: BSD-3-Clause
// There are three kinds of failure, which differ in the ranks that detect them
// (docs/understanding/architecture.md): 1. a wrong input, which all ranks find; 2. a failed
// operation of all ranks, which all ranks report together; 3. a broken invariant, which one rank
// may find alone. The first two are exceptions of the public API.
#pragma once

#include <string_view>

#include <carrom/errors.hpp>

#include "core/device.hpp"

namespace carrom {

/// Ends the program when an invariant is broken. Release builds do this, too, because a wrong
/// number must never look like a result. The default handler prints `text` and aborts; the parallel
/// module installs a handler that aborts all ranks.
[[noreturn]] void fail(std::string_view text, const char* file, int line);
using FailureHandler = void (*)(std::string_view text, const char* file, int line);
void set_failure_handler(FailureHandler handler);

/// Calls `fail` if `claim` is false. On a GPU a false claim stops the kernel, and the host reports
/// an error.
CARROM_DEVICE inline void ensure(bool claim, std::string_view text,
                                 const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
#ifdef __CUDA_ARCH__
    if (!claim) __trap();
#else
    if (!claim) [[unlikely]]
        fail(text, file, line);
#endif
}

} // namespace carrom
