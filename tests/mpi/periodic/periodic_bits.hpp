// SPDX-License-Identifier: BSD-3-Clause
// Compares scenes with periodic sides with the references of both methods, bit by bit.
#pragma once

#include "scene_tools.hpp"

namespace carrom::test {

/// Checks windows of several lengths, strips with changed cuts, and a run that is stopped and
/// started again. The calls are divided among machine shapes (shape_parts.hpp). **Collective.**
void check_bits(const TestScene& scene, Method method);

} // namespace carrom::test
