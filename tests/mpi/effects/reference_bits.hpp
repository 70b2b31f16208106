// SPDX-License-Identifier: BSD-3-Clause
// Scenes held to the plain statements of both methods, bit for bit.
#pragma once

#include <vector>

#include "effect_runs.hpp"

namespace carrom::test {

/// Checks a scene against the rule's own statement: windows of several lengths, and a run that is
/// stopped and begun again on the way. Shapes share the calls out (shape_parts.hpp).
/// **Collective.**
void check_bits(const TestScene& scene, Method method);

/// A thin gas, a dense one, a rack that is broken and a cradle.
std::vector<TestScene> base_scenes();

} // namespace carrom::test
