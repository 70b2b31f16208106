// SPDX-License-Identifier: BSD-3-Clause
// Records requests to stop a run, which signal handlers make, and defines the exception that stops
// all ranks.
//
// A run normally stops between two steps. If a start or a step is still running when the patience
// (`set_stop_patience`) has passed since the request, it is abandoned. Ranks get signals at
// different times, so they must agree before they throw.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "core/errors.hpp"

namespace carrom {

namespace stop_request {
/// Time of the request in nanoseconds of the steady clock; 0 if there is none
extern std::atomic<std::int64_t> requested_at;
bool has_patience_ended();
} // namespace stop_request

/// Records a request; only the first one counts. Signal handlers may call it.
void request_stop();

inline bool is_stop_requested() {
    return stop_request::requested_at.load(std::memory_order_relaxed) != 0;
}

/// Whether more time than the patience has passed since the request, so that the present start or
/// step should be abandoned. Costs one comparison while there is no request.
inline bool is_stop_overdue() { return is_stop_requested() && stop_request::has_patience_ended(); }

/// Sets the patience: how long a start or a step may take after a request. The default is 1 s.
void set_stop_patience(double seconds);

/// Thrown on every rank if a start or a step was abandoned because of a request. The simulation's
/// state is then inconsistent. Exit code 75.
class StopRequested : public CollectiveError {
public:
    explicit StopRequested(const std::string& text) : CollectiveError(text, ExitCode::stopped) {}
};

} // namespace carrom
