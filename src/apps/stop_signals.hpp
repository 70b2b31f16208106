// SPDX-License-Identifier: BSD-3-Clause
// USR1 and TERM, as batch systems send them before they end a job, and Ctrl-C's INT: noted, to be
// acted upon at the end of a step. A second INT ends the process.
#pragma once

namespace carrom {

/// From its making on these signals no longer end the process; one per program.
class StopSignals {
public:
    /// Where `are_told` the first one is answered on standard error at once, for the end of a step
    /// may be far away.
    explicit StopSignals(bool are_reported);
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

    /// Whether this rank has got one. Ranks get theirs at different times.
    bool has_come() const;
};

} // namespace carrom
