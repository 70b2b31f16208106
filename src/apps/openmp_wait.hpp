// SPDX-License-Identifier: BSD-3-Clause
// How long threads that wait for each other spin before they sleep.
#pragma once

namespace carrom {

/// Bounds it to tens of microseconds, unless OMP_WAIT_POLICY or GOMP_SPINCOUNT say otherwise. To be
/// called first in main: GNU's OpenMP library reads its settings before main and offers no other
/// way, so the program starts itself once more, as the same process with the same arguments. Where
/// that fails it goes on as it is.
///
/// Left to itself the library spins for milliseconds, which on cores that others use too takes the
/// time of the very thread that is waited for: ten times slower (docs/performance.md). Sleeping at
/// once costs half the speed of small scenes.
void bound_openmp_wait(char** arguments);

} // namespace carrom
