// SPDX-License-Identifier: BSD-3-Clause
// `carrom accuracy`: how wrong is a setting, and how long does it take? Runs a scene under many
// settings from the same starts and writes a table; docs/tools/plot_accuracy.py draws it.
#pragma once

#include "apps/subcommand.hpp"

namespace carrom {

Subcommand accuracy_subcommand();

} // namespace carrom
