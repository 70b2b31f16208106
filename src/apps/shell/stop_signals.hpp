// SPDX-License-Identifier: BSD-3-Clause
// Stops a run on USR1 and TERM, which batch systems send before they end a job, and on INT
// (Ctrl-C). A signal is recorded; the run stops at the end of the step, or inside a step that takes
// too long (core/stop_request.hpp). A second INT ends the process.
#pragma once

namespace carrom {

/// Makes the process record these signals until it exits, because a signal after the last step must
/// not make a complete run fail. Call it before MPI starts.
void record_stop_signals();

class StopSignals {
public:
    /// Calls `record_stop_signals`. If `are_reported`, the first signal is
    /// immediately reported on standard error, because the present step may take
    /// long.
    explicit StopSignals(bool are_reported);
    ~StopSignals(); ///< from here on signals are recorded without a message
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
};

} // namespace carrom
