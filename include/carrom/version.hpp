// SPDX-License-Identifier: BSD-3-Clause
// The version of the library that a program is linked with.
#pragma once

#include <string>

namespace carrom {

/// The version, such as "0.3.0". Not collective.
std::string version();

} // namespace carrom
