// SPDX-License-Identifier: BSD-3-Clause
// Lets waiting threads sleep, unless the user has chosen otherwise.
//
// By default a waiting thread of GNU's OpenMP library spins for milliseconds, on the very core that
// another program or the awaited thread needs. On cores that are busy a run of a thousand discs
// took 8 s then, and 0.1 s with threads that sleep; on idle cores there is no difference.
#pragma once

namespace carrom {

/// Starts the program anew with OMP_WAIT_POLICY=passive, because OpenMP reads it as it is loaded.
/// The processors that threads may use stay those of the start, where OpenMP has bound this thread
/// to one of them. Returns if the user has set OMP_WAIT_POLICY or GOMP_SPINCOUNT, or if the program
/// cannot be restarted. Call it before MPI and threads are started.
void let_threads_sleep(char** arguments);

} // namespace carrom
