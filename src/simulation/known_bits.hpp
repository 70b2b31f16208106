// SPDX-License-Identifier: BSD-3-Clause
// Tests whether this build, on this processor, computes the same bits as other builds.
//
// Not all compiler flags that change floating-point arithmetic can be detected when compiling, and
// libraries may set modes of the processor at run time. So a program runs two small scenes, one for
// each method, before the user's scene, and compares their state hashes with recorded hashes.
// Cost: about a millisecond.
#pragma once

#include <string>

#include "parallel/communicator.hpp"

namespace carrom {

/// A warning if a rank computes other bits, otherwise empty. Every rank runs the scenes, because
/// ranks may have different processors. **Collective.**
std::string warning_of_other_bits(const Communicator& ranks);

} // namespace carrom
