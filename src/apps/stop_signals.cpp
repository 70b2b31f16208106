// SPDX-License-Identifier: BSD-3-Clause
#include "stop_signals.hpp"

#include <csignal>

namespace carrom {

namespace {

volatile std::sig_atomic_t signal_that_has_come = 0;

void note_signal(int number) { signal_that_has_come = number; }

void handle(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART; // reads and writes under way go on
    sigemptyset(&action.sa_mask);
    sigaction(SIGUSR1, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

} // namespace

StopSignals::StopSignals() { handle(note_signal); }

StopSignals::~StopSignals() { handle(SIG_DFL); }

bool StopSignals::has_come() const { return signal_that_has_come != 0; }

} // namespace carrom
