// SPDX-License-Identifier: BSD-3-Clause
// USR1 and TERM, as batch systems send them before they end a job, and Ctrl-C's INT: noted, to be
// acted upon at the end of a step, or inside one that takes long (core/stop_request.hpp). A second
// INT ends the process.
#pragma once

namespace carrom {

/// From here on these signals no longer end the process, to its very end: one that comes after the
/// last step must not make a failure of a complete run. To be called before MPI starts.
void note_stop_signals();

class StopSignals {
public:
    /// Notes them from here on if `note_stop_signals` has not been called. Where `are_reported`,
    /// the first one is answered on standard error at once: the end of a step may be far away.
    explicit StopSignals(bool are_reported);
    ~StopSignals(); ///< no answers any more
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

    /// Whether this rank has got one. Ranks get theirs at different times.
    bool has_come() const;
};

} // namespace carrom
