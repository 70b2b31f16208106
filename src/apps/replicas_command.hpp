// SPDX-License-Identifier: BSD-3-Clause
// `carrom replicas`: independent runs of one scene, each on a rank of its own, and their averages.
#pragma once

#include "apps/subcommand.hpp"

namespace carrom {

Subcommand replicas_subcommand();

} // namespace carrom
