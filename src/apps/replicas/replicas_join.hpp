// SPDX-License-Identifier: BSD-3-Clause
// Joins the results of independent runs of one scene: means, and errors from the runs' scatter.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.hpp"

namespace carrom {

/// A run that has ended: its folder and the seed of its discs.
struct Replica {
    std::string folder;
    std::uint64_t seed = 0;
};

/// One problem for each file in the folder that replicas have not written, but might replace.
std::vector<Problem> problems_with_joined_files(const std::string& folder);

/// The last step of the run in the folder, from its report; nullopt if there is no complete report.
std::optional<std::int64_t> last_step_reported(const std::string& folder);

/// The joint results as text for the terminal.
struct JoinedReplicas {
    std::string averages;
    std::string warning; ///< one line; empty if there is no warning
};

/// Reads the replicas' reports and writes to `folder`:
///   replicas.csv   a line for each replica: number, seed, state hash, averages
///   replicas.json  each average over the replicas: value and standard error of the mean, and how
///                  the scatter between replicas compares with the errors that they report
///   NAME.csv       each measured table with equal shape in all replicas: means and their errors
/// Throws CollectiveError (code 4) if a file cannot be written, and InputError if a report cannot
/// be read. Call it on one rank.
JoinedReplicas join_replicas(const std::vector<Replica>& replicas, const std::string& folder);

} // namespace carrom
