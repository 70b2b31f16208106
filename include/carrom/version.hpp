// SPDX-License-Identifier: BSD-3-Clause
// Which version of the library a program is linked with.
#pragma once

#include <string>

namespace carrom {

/// "0.3.0". Not collective.
std::string version();

} // namespace carrom
