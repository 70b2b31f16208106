// SPDX-License-Identifier: BSD-3-Clause
// Preloaded by tests on MPICH, whose ranks spin while they wait: more ranks than cores then take
// five to ten times as long as with Open MPI. MPICH on UCX asks UCX for progress time and again.
// Where there is none, this rank gives way to others.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <sched.h>

unsigned ucp_worker_progress(void* worker) {
    static unsigned (*progress)(void*);
    if (!progress) progress = (unsigned (*)(void*))dlsym(RTLD_NEXT, "ucp_worker_progress");
    const unsigned n_events = progress(worker);
    if (n_events == 0) sched_yield();
    return n_events;
}
