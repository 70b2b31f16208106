// SPDX-License-Identifier: BSD-3-Clause
// Compares scenes with the references of both methods, bit by bit.
#pragma once

#include <vector>

#include "effect_runs.hpp"

namespace carrom::test {

/// Compares a scene with the reference: windows of several lengths, and a run that is stopped and
/// started again. The calls are divided among machine shapes (shape_parts.hpp). **Collective.**
void check_bits(const TestScene& scene, Method method);

/// A dilute gas, a dense one, a break shot and a cradle.
std::vector<TestScene> base_scenes();

} // namespace carrom::test
