// SPDX-License-Identifier: BSD-3-Clause
#include "core/stop_request.hpp"

#include <chrono>

namespace carrom {

namespace stop_request {

std::atomic<std::int64_t> requested_at = 0;
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "handlers of signals write it");

namespace {

/// How long a start or a step may still take after a request, in nanoseconds
std::atomic<std::int64_t> patience = 1'000'000'000;

std::int64_t now() {
    const auto since_boot = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(since_boot).count();
}

} // namespace

bool has_patience_ended() { return now() - requested_at > patience; }

} // namespace stop_request

void request_stop() {
    std::int64_t never = 0;
    stop_request::requested_at.compare_exchange_strong(never, stop_request::now());
}

void set_stop_patience(double seconds) {
    stop_request::patience = static_cast<std::int64_t>(seconds * 1e9);
}

} // namespace carrom
