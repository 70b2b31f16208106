// SPDX-License-Identifier: BSD-3-Clause
// What `carrom --version` prints: what a report of a problem should say.
#pragma once

#include <string>

namespace carrom {

/// Several lines, "carrom 0.2.0" first. Needs no MPI. Not collective.
std::string version_text();

} // namespace carrom
