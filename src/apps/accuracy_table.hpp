// SPDX-License-Identifier: BSD-3-Clause
// The table that `carrom accuracy` writes: CSV, a line for each trial, appended as soon as it is done. A study that was
// stopped goes on where its table ends; tables of several processes are put together by concatenation.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "trial.hpp"

namespace carrom {

/// What tells one line of a table from another; a line begins with it.
struct TrialKey {
    int start = 0; ///< number of the start, from 0
    RunSetting setting;
    TrialLength length;
};

/// How far a trial's discs are from the exact run's at the early step, in diameters.
struct Distance {
    double root_mean_square = 0, median = 0;
};

class AccuracyTable {
public:
    /// Opens `path` to append to, and drops a line that was half written. Throws InputError where it cannot be written or
    /// is another table.
    explicit AccuracyTable(std::string path);

    bool has(const Scene& scene, const TrialStart& start, const TrialKey& key) const;
    /// Adds a line and brings it to disk; throws InputError where that fails.
    void add(const Scene& scene, const TrialStart& start, const TrialKey& key, const Trial& trial, const Distance& distance,
             int threads);
    /// A trial that could not be run: the line holds the reason, and no numbers.
    void add_failure(const Scene& scene, const TrialStart& start, const TrialKey& key, const std::string& reason, int threads);

private:
    void append(const std::string& key, const std::vector<std::string>& fields, const std::string& failure, int threads);

    std::string path_;
    std::set<std::string> keys_;
};

} // namespace carrom
