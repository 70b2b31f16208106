// SPDX-License-Identifier: BSD-3-Clause
// The part of a scene's check that looks at `[output.measurements]`.
#pragma once

#include "scene/check.hpp"

namespace carrom {

/// Keys whose quantity is not asked for are refused.
void fill_measurements(const Check& check);
/// Whether there is something to measure, and how far the radial distribution may look, once the
/// box and the discs' radius are known.
void check_measured_box(const Check& check);

} // namespace carrom
