// SPDX-License-Identifier: BSD-3-Clause
// USR1 and TERM, which batch systems send before they end a job, and the INT of Ctrl-C. They are
// recorded, and take effect at the end of a step, or inside a step that takes long
// (core/stop_request.hpp). A second INT ends the process.
#pragma once

namespace carrom {

/// From here on these signals do not end the process, to its very end, because one that comes
/// after the last step must not make a complete run fail. To be called before MPI starts.
void record_stop_signals();

class StopSignals {
public:
    /// Calls `record_stop_signals`, so that signals are recorded from here on. If `are_reported`,
    /// the first signal is answered on standard error at once, because the end of the step may be
    /// far away.
    explicit StopSignals(bool are_reported);
    ~StopSignals(); ///< signals are no longer answered
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
};

} // namespace carrom
