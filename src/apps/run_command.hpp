// SPDX-License-Identifier: BSD-3-Clause
// `carrom run`: from a scene to its last step, with its lines on standard output and a summary at
// the end.
#pragma once

#include "apps/subcommand.hpp"

namespace carrom {

Subcommand run_subcommand();

} // namespace carrom
