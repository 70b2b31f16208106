// SPDX-License-Identifier: BSD-3-Clause
// Small files of each kind to be damaged, and how a damaged checkpoint is given the seal that a
// writer of just these bytes would have given it.
#pragma once

#include <string>
#include <vector>

#include "io/trajectory.hpp"
#include "parallel/communicator.hpp"

namespace carrom::test {

/// All bytes of a file.
std::vector<char> bytes_of(const std::string& path);
/// Replaces the file.
void write_bytes(const std::string& path, const std::vector<char>& bytes);

/// Twelve rough discs at step 70 of a scene of the time-stepped method. **Collective.**
void write_sample_checkpoint(const std::string& path, const Communicator& world);

/// Three frames of twelve discs with their counters; compressed, and with angular velocities, or
/// not. **Collective.**
TrajectoryLayout sample_layout(bool is_double);
void write_sample_trajectory(const std::string& path, bool is_double,
                             const Communicator& world);

/// Twenty collisions. **Collective.**
void write_sample_log(const std::string& path, const Communicator& world);

/// Seals a checkpoint that holds `bytes` anew; its seal must still name its parts. Of one rank.
void seal_anew(const std::string& path, const std::vector<char>& bytes);

} // namespace carrom::test
