// SPDX-License-Identifier: BSD-3-Clause
// Discs of several radii and masses: `[[discs.classes]]`, or two more numbers in each row of `discs.list`.
#pragma once

#include "check.hpp"

namespace carrom {

/// Fills in `scene.effects.classes`, which stay empty where neither is there, and refuses what does not go with them.
void fill_classes(const Check& check);

/// What gave the classes, or null.
const Setting* classes_setting(const Check& check);

} // namespace carrom
