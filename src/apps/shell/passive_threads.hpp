// SPDX-License-Identifier: BSD-3-Clause
// Lets waiting threads sleep, unless the user has chosen otherwise.
//
// By default a waiting thread of GNU's OpenMP library spins for milliseconds, and another program
// or thread that needs the core has to wait. With busy cores a run of a thousand discs took 8 s,
// but 0.1 s with threads that sleep; with idle cores there is no difference.
#pragma once

namespace carrom {

/// Restarts the program with OMP_WAIT_POLICY=passive and GOMP_SPINCOUNT=1000, because OpenMP reads
/// these variables when it is loaded. The new program may use all processors of the old one,
/// although OpenMP may have bound this thread to one of them. Returns under valgrind, if the user
/// has set one of the two, or if the restart fails. Call it before MPI and threads are started.
void let_threads_sleep(char** arguments);

} // namespace carrom
