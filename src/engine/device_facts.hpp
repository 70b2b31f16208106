// SPDX-License-Identifier: BSD-3-Clause
// What messages and reports say of a GPU.
#pragma once

#include <cstdint>
#include <string>

namespace carrom {

struct DeviceFacts {
    std::string name;
    std::uint64_t bytes = 0, free_bytes = 0; ///< of its memory
};

} // namespace carrom
