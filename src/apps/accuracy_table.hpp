// SPDX-License-Identifier: BSD-3-Clause
// The tables that `carrom accuracy` writes: a line for each trial, or, of distances along time, one
// for each look.
#pragma once

#include <string>
#include <vector>

#include "apps/csv_table.hpp"
#include "apps/trial.hpp"

namespace carrom {

/// What tells one trial from another; a line begins with it.
struct TrialKey {
    int start = 0; ///< number of the start, from 0
    RunSetting setting;
    TrialLength length;
    int repetition = 0; ///< the same trial again, for its cost
};

/// How far discs are from those of another run, in diameters.
struct Distance {
    double root_mean_square = 0, median = 0;
};

class AccuracyTable {
public:
    /// Throws as CsvTable does.
    explicit AccuracyTable(const std::string& path);

    /// Adds a line; `distance` is that to the exact run at the early step. Throws where that fails.
    void add(const Scene& scene, const TrialStart& start, const TrialKey& key, const Trial& trial,
             const Distance& distance, int threads);
    /// A trial that could not be run: the line holds the reason, and no numbers.
    void add_failure(const Scene& scene, const TrialStart& start, const TrialKey& key,
                     const std::string& reason, int threads);

private:
    void append(const std::string& key, const std::vector<std::string>& fields,
                const std::string& failure, int threads);

    CsvTable table_;
};

/// Distances of one trial to the exact run, look by look.
class DistanceTable {
public:
    /// Throws as CsvTable does.
    explicit DistanceTable(const std::string& path);

    /// `collisions` are those that a disc has had with others in the exact run until then.
    void add(const Scene& scene, const TrialStart& start, const TrialKey& key, std::int64_t step,
             double collisions, const Distance& distance);

private:
    CsvTable table_;
};

} // namespace carrom
