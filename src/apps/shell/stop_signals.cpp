// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/stop_signals.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string_view>

#include <unistd.h>

#include "core/stop_request.hpp"

namespace carrom {

namespace {

// Atomic, because any thread of the process may run the handler; `volatile` is not enough.
std::atomic<int> signal_that_has_come = 0; // used only in the message
std::atomic<bool> is_answer_due = false;

/// Prints a message about a signal. Signal handlers call it, so it is async-signal-safe.
void answer(int number) {
    constexpr std::string_view text = "\ntold to stop: the steps under way are finished first if "
                                      "that takes no more than a second";
    constexpr std::string_view advice = "; once more ends the run at once";
    for (const std::string_view part :
         {text, number == SIGINT ? advice : std::string_view(), std::string_view("\n")}) {
        // A failure is ignored, because nobody could read a message about it.
        [[maybe_unused]] const ssize_t n_written = write(STDERR_FILENO, part.data(), part.size());
    }
}

void record_signal(int number) {
    signal_that_has_come = number;
    request_stop();
    if (!is_answer_due.exchange(false)) return;
    const int number_of_error = errno;
    answer(number);
    errno = number_of_error;
}

} // namespace

void record_stop_signals() {
    static bool are_noted = false;
    if (are_noted) return; // a second call would mistake our own handler for the default
    are_noted = true;
    struct sigaction action{};
    action.sa_handler = record_signal;
    action.sa_flags = SA_RESTART; // system calls in progress continue after the signal
    sigemptyset(&action.sa_mask);
    sigaction(SIGUSR1, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    struct sigaction present{};
    sigaction(SIGINT, nullptr, &present);
    if (present.sa_handler == SIG_IGN) return; // shells ignore SIGINT for background processes
    action.sa_flags |= SA_RESETHAND;           // a second Ctrl-C ends the process
    sigaction(SIGINT, &action, nullptr);
}

StopSignals::StopSignals(bool are_reported) {
    record_stop_signals();
    if (!are_reported) return;
    is_answer_due = true;
    if (signal_that_has_come == 0 || !is_answer_due.exchange(false)) return;
    answer(signal_that_has_come);
}

StopSignals::~StopSignals() { is_answer_due = false; }

} // namespace carrom
