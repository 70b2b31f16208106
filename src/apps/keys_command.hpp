// SPDX-License-Identifier: BSD-3-Clause
// `carrom keys`: the reference of scene keys, on standard output.
#pragma once

#include "apps/subcommand.hpp"

namespace carrom {

Subcommand keys_subcommand();

} // namespace carrom
