// SPDX-License-Identifier: BSD-3-Clause
#include "apps/stop_signals.hpp"

#include <cerrno>
#include <csignal>
#include <string_view>

#include <unistd.h>

namespace carrom {

namespace {

volatile std::sig_atomic_t signal_that_has_come = 0, is_answer_due = 0;

/// Calls only what a handler may call.
void note_signal(int number) {
    signal_that_has_come = number;
    if (is_answer_due == 0) return;
    is_answer_due = 0;
    constexpr std::string_view text = "\ntold to stop: the steps under way are finished first, two "
                                      "seconds' worth of them or one\n";
    constexpr std::string_view text_of_interrupt =
        "\ntold to stop: the steps under way are finished first, two seconds' worth of them or "
        "one; once more ends the run at once\n";
    const std::string_view answer = number == SIGINT ? text_of_interrupt : text;
    const int number_of_error = errno;
    [[maybe_unused]] const ssize_t n_written = write(STDERR_FILENO, answer.data(),
                                                     answer.size()); // nobody to tell if it fails
    errno = number_of_error;
}

void handle(void (*handler)(int)) {
    struct sigaction action{};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART; // reads and writes under way go on
    sigemptyset(&action.sa_mask);
    sigaction(SIGUSR1, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    struct sigaction present{};
    sigaction(SIGINT, nullptr, &present);
    if (present.sa_handler == SIG_IGN) return; // as shells have it for what runs in the background
    action.sa_flags |= SA_RESETHAND;           // whoever asks again does not want to wait
    sigaction(SIGINT, &action, nullptr);
}

} // namespace

StopSignals::StopSignals(bool are_reported) {
    is_answer_due = are_reported ? 1 : 0;
    handle(note_signal);
}

StopSignals::~StopSignals() { handle(SIG_DFL); }

bool StopSignals::has_come() const { return signal_that_has_come != 0; }

} // namespace carrom
