// SPDX-License-Identifier: BSD-3-Clause
// A request to stop, as a signal handler records it, and the exception with which all ranks stop.
//
// A run stops between two steps. Work that takes too long for that ends inside: a start, or a step
// that does not end within the patience. Ranks get signals at different times, so they must agree
// before they throw.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "core/errors.hpp"

namespace carrom {

namespace stop_request {
/// Time of the request in nanoseconds of the steady clock; 0: none
extern std::atomic<std::int64_t> requested_at;
bool has_patience_ended();
} // namespace stop_request

/// Records a request; only the first one counts. Signal handlers may call it.
void request_stop();

inline bool is_stop_requested() {
    return stop_request::requested_at.load(std::memory_order_relaxed) != 0;
}

/// Whether the request is older than the patience, so that the present step should be abandoned.
/// Costs one comparison as long as there is no request.
inline bool is_stop_overdue() { return is_stop_requested() && stop_request::has_patience_ended(); }

/// Sets how long a step may still take after a request. It is a second unless this is called.
void set_stop_patience(double seconds);

/// Thrown on every rank if a start or a step is abandoned because of a request. The simulation is
/// then in no consistent state. Exit code 75.
class StopRequested : public CollectiveError {
public:
    explicit StopRequested(const std::string& text) : CollectiveError(text, ExitCode::stopped) {}
};

} // namespace carrom
