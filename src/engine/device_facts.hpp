// SPDX-License-Identifier: BSD-3-Clause
// Facts about a GPU for messages and reports.
#pragma once

#include <cstdint>
#include <string>

namespace carrom {

struct DeviceFacts {
    std::string name;
    std::uint64_t bytes = 0, free_bytes = 0; ///< total and free memory of the GPU
};

} // namespace carrom
