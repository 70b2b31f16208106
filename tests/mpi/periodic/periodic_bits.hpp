// SPDX-License-Identifier: BSD-3-Clause
// Scenes with periodic sides held to the plain statements of both methods, bit for bit.
#pragma once

#include "scene_tools.hpp"

namespace carrom::test {

/// Checks windows of several lengths, strips that are cut anew, and a run that is stopped and begun
/// again on the way. Shapes share the calls out (shape_parts.hpp). **Collective.**
void check_bits(const TestScene& scene, Method method);

} // namespace carrom::test
