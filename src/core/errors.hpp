// SPDX-License-Identifier: BSD-3-Clause
// The kinds of failure, divided by which ranks know about them
// (docs/understanding/architecture.md). The input is wrong, and every rank knows it. Or a
// collective operation fails on some rank, and all ranks agree on it. Or an invariant is broken.
// The first two are exceptions of the public API.
#pragma once

#include <string_view>

#include <carrom/errors.hpp>

#include "core/device.hpp"

namespace carrom {

/// Ends the program when an invariant is broken. It also does so in Release builds, because a wrong
/// number must never look like a result. The handler prints and aborts; the parallel module
/// installs one that aborts all ranks.
[[noreturn]] void fail(std::string_view text, const char* file, int line);
using FailureHandler = void (*)(std::string_view text, const char* file, int line);
void set_failure_handler(FailureHandler handler);

/// On a GPU a failure stops the kernel, and the host reports it.
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
