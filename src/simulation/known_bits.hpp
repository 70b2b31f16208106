// SPDX-License-Identifier: BSD-3-Clause
// Whether this build, on this processor, computes the bits that every other one does.
// Compiler flags that change floating-point arithmetic cannot all be seen when compiling, and
// libraries may set modes of the processor at run time. So a program runs two small scenes,
// one for each method, before the user's, and compares their state hashes with recorded ones.
//
// Price: about a millisecond.
#pragma once

#include <string>

#include "parallel/communicator.hpp"

namespace carrom {

/// A warning if a rank computes other bits, else empty. Every rank runs the scenes by
/// itself, because ranks may have different processors. **Collective.**
std::string warning_of_other_bits(const Communicator& ranks);

} // namespace carrom
