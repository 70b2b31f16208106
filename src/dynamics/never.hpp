// SPDX-License-Identifier: BSD-3-Clause
// The time of an event that never happens.
#pragma once

#include <limits>

namespace carrom {

inline constexpr double never = std::numeric_limits<double>::infinity();

} // namespace carrom
